"""Makes a drawing of a model and its solution: names with places, exact curves, regions, measures."""
