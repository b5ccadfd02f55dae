"""The forces between grains in pictures, as chains; `lab.recording.contacts` finds them."""
