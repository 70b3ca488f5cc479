[
  (block)
  (constraint_block)
  (argument_block)
  (parameters)
  (arguments)
  (parenthesized_expression)
  (point)
  (list)
  (subscript)
] @indent.begin

[
  "}"
  ")"
  "]"
] @indent.branch

(block
  "}" @indent.end)

(constraint_block
  "}" @indent.end)

(argument_block
  "}" @indent.end)

[
  (line_comment)
  (doc_comment)
  (ERROR)
] @indent.auto

(block_comment) @indent.ignore
