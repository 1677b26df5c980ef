"""Previews in viewports."""
