"""The site: the pages of `docs/` as HTML, with search, and links that open programs in the playground."""
