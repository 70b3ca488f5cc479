"""The pages made from the library's own comments: reference, coverage, gallery, guide, `llms.txt`."""
