"""Reports on a whole hull: limiting KG and longitudinal strength."""
