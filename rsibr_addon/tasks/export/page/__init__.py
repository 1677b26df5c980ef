"""One web page that shows a map set on a mesh, without a network."""
