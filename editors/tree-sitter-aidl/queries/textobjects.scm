(structure
  body: (block) @class.inner) @class.outer

(shape_definition
  body: (block) @function.inner) @function.outer

(constraint_definition
  body: (constraint_block) @function.inner) @function.outer

(function_definition
  value: (_) @function.inner) @function.outer

(for_statement
  body: (_) @loop.inner) @loop.outer

(for_arguments
  body: (_) @loop.inner) @loop.outer

(if_statement
  consequence: (_) @conditional.inner) @conditional.outer

(if_arguments
  consequence: (_) @conditional.inner) @conditional.outer

(call_expression
  arguments: (arguments) @call.inner) @call.outer

(parameters
  (parameter) @parameter.inner @parameter.outer)

(arguments
  (_) @parameter.inner @parameter.outer)

[
  (line_comment)
  (doc_comment)
  (block_comment)
] @comment.outer
