"""What a task to learn is: what agents see and do, rewards, goals, cases, and the files that say so."""
