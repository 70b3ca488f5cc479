"""Evaluation of models: prompts, requirements on their drawings, and runs over both."""
