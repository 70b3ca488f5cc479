"""Tools for agents: the language as functions that a language model can call, and a server for them.

`tools` has the functions, `calling` calls one by its name with arguments that came as JSON, `schema`
describes them, and `server` serves them over the Model Context Protocol.
"""
