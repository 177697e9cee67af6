"""Set-up of the robots that come with Lumen, each with its clock and hall."""
