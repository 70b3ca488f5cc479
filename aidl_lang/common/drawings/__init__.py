"""Drawings of other programs: the outlines in an SVG or a DXF file, under names, in millimetres with y up."""
