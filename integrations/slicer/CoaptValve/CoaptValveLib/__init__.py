"""Parts of the module CoaptValve."""
