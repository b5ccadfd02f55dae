"""Water in pictures: a smooth surface from its particles, spray, fields in colours, and the gauges in the tank."""
