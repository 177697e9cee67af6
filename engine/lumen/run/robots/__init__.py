"""How each of the robots that come with Lumen is set up, with its clock and the hall around it."""
