"""Problems for the solver in files of their own: see README.md."""
