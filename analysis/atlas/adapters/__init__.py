"""The atlas in the codes that use it: README.md of this folder."""
