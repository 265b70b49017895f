"""The pages that explain the kit: one source, shown in the terminal and as a folder of HTML."""
