[
  (block)
  (constraint_block)
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
