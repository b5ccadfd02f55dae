"""What stands around the matter: tank, ship, sea and sky, and the arrow of what drives them."""
