; Names belong to the block, definition, loop or comprehension that they stand in.
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
  name: (identifier) @local.definition.parameter)

(param_declaration
  name: (identifier) @local.definition.var)

(var_declaration
  name: (identifier) @local.definition.var)

(let_declaration
  name: (identifier) @local.definition.var)

(assignment
  target: (identifier) @local.definition.var)

(variables
  (identifier) @local.definition.var)

(import_statement
  name: (identifier) @local.definition.import)

(import_statement
  alias: (identifier) @local.definition.namespace)

; Known around the definition, not only in it.
((structure
  name: (identifier) @local.definition.type)
  (#set! definition.type.scope "parent"))

((function_definition
  name: (identifier) @local.definition.function)
  (#set! definition.function.scope "parent"))

((shape_definition
  name: (identifier) @local.definition.function)
  (#set! definition.function.scope "parent"))

((constraint_definition
  name: (identifier) @local.definition.function)
  (#set! definition.function.scope "parent"))

(alias_declaration
  name: (identifier) @local.definition.function)

(identifier) @local.reference
