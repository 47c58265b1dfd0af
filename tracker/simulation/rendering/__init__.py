"""What the simulated cameras see: people, furniture and rooms as pictures and depth."""
