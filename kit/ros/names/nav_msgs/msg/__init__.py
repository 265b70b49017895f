from kit.msg.nav_msgs import GridCells, MapMetaData, OccupancyGrid, Odometry, Path

__all__ = ["GridCells", "MapMetaData", "OccupancyGrid", "Odometry", "Path"]
