"""From a sentence to a program: language models asked, their programs checked, what they lose asked back."""
