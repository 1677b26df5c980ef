"""What a user asks for, from start to end: one task per file, made of files, host and device."""
