"""Pictures in a terminal: its protocol, its size, and pixels in a form that it understands.

Pure functions. They know nothing of drawings; what is drawn for them comes from `export/marks.py`.
"""
