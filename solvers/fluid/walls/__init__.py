"""Walls for water: layers of wall particles behind them, their pressures, and gauges in them."""
