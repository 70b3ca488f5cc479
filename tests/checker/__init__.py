"""A second opinion on solved models: every constraint evaluated on the exported coordinates alone."""
