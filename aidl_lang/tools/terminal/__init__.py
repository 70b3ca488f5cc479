"""Pictures in a terminal: what it can show, how large, and pixels as what it understands.

Pure functions. They know nothing of drawings; what is drawn for them comes from `export/coarse.py`.
"""
