"""From photographs, paintings and scenes to environments.

`output` is NAME.exr or NAME.hdr: see `files.radiance_pictures.write_radiance`, which raises an
OutputFileError or a RangeError where it cannot hold the environment.
"""
