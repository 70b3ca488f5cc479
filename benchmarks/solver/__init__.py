"""The solver against its peers: one sketch format, one judge, everyone measured in the same run."""
