"""The chapters of a class's report: each turns a class's numbers into tables, plots and cautions."""
