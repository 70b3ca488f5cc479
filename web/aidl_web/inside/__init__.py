"""What runs in the browser: the host of the pane, and what `aidl_lang` counts on there."""
