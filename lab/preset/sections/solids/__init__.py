"""Tanks that files hold."""
