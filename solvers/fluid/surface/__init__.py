"""What tells water that is packed from water that is broken."""
