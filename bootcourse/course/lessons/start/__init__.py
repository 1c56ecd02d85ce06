"""You will drive the trap, see your drive in 3D beside two agents, choose a route through the course."""
