"""What is seen in each pixel of a picture in space, and its colour."""
