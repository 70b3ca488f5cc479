"""What there is to say of a solution: who conflicts, what gave way, what would fit, which assertions fail.

What would help is tried on the program before it is said (`trials`). `outcome` tells a drawing that solved.
"""
