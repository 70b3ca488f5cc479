[
  (source_file)
  (structure)
  (block)
  (constraint_block)
  (argument_block)
  (function_definition)
  (shape_definition)
  (constraint_definition)
  (for_statement)
  (for_arguments)
  (comprehension)
] @local.scope

(parameter
  name: (identifier) @local.definition.variable.parameter)

(variables
  (identifier) @local.definition.variable)

(let_declaration
  name: (identifier) @local.definition.variable)

(identifier) @local.reference

; Members, and names of arguments, refer to nothing around them.
(member_expression
  property: (identifier) @_member)

(named_argument
  name: (identifier) @_argument)
