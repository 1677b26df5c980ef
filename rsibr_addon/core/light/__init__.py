"""Light before it is filtered: photographs, paintings, lamps."""
