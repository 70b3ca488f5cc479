"""Model and solution become a drawing: places put back into names, exact curves, regions, what they measure.

`picturing` is the way through: `readout` (numbers), `outlines` and `finishing` (what is made of outlines),
`network`, `faces`, `boolean` (curves become regions), `drawing`.
"""
