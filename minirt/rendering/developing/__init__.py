"""The last step of a picture: light becomes levels of 8 bits, by a tone curve and with or without dithering."""
