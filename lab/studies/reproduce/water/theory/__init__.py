"""Water by other methods than particles, to hold these against: potential flow, shallow water, finite differences."""
