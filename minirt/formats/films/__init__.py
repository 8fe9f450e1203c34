"""Writers of films. A writer takes one picture after the other and keeps the last one alone."""
