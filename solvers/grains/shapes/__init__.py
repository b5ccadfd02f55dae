"""Outlines of irregular grains: how they are described, where they come from, and how deep two of them overlap."""
