"""What is asked: dialogues, their actions and effects, and what decides for every face."""
