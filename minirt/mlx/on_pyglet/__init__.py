"""The back end on a real screen. Importing any module in here opens the display."""
