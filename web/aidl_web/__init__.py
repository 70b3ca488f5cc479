"""The playground: the preview in a page without a server, its language server in a worker of the browser."""
