"""Walls for water: layers of dummy particles behind them, their pressures, and gauges in them."""
