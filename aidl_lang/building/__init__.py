"""Running a program: the passes behind `interp`."""
