"""The study of an evaluation: a local page on which people rank pictures without knowing their languages."""
