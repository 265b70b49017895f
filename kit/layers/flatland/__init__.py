"""Layer plans of Flatland worlds: reading a world as a case, and writing a plan back into its files."""
