"""From a sentence to a program: asks language models, checks their programs, asks back for what they lose."""
