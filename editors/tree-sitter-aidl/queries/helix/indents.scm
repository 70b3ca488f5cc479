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
] @indent

[
  "}"
  ")"
  "]"
] @outdent
