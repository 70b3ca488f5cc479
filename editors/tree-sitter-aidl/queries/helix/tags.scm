(structure
  name: (identifier) @name) @definition.class

(function_definition
  name: (identifier) @name) @definition.function

(shape_definition
  name: (identifier) @name) @definition.class

(constraint_definition
  name: (identifier) @name) @definition.function

(param_declaration
  name: (identifier) @name) @definition.constant
