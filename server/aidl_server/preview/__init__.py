"""`aidl preview`: the preview pane on localhost, beside any editor."""
