"""Pages, plots and tables of Monte Carlo studies and of searches for parameters."""
