[
  (block)
  (constraint_block)
  (argument_block)
  (parameters)
  (arguments)
  (list)
  (block_comment)
] @fold

(doc_comment)+ @fold

(line_comment)+ @fold

(import_statement)+ @fold
