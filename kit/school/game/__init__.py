"""The game: levels from the first drive to two wheelchairs, stars, ghosts, time trials, a leaderboard."""
