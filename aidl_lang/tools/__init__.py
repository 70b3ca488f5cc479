"""All that stands on the pipeline: command line, editors, agents, language models, evaluation, reference."""
