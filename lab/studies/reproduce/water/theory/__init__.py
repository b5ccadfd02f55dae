"""Water by other theories than particles, to hold these against: potential flow, linear and not, and shallow water."""
