"""The requests of the protocol by theme; each module has a `register` that enters its own at the server."""
