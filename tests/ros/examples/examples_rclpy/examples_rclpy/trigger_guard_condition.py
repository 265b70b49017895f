"""A timer triggers a guard condition, whose callback ends the program."""

import rclpy


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("demo_guard_condition")
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)

    def guard_condition_callback():
        rclpy.shutdown()
        node.get_logger().info("guard callback called shutdown")

    def timer_callback():
        guard_condition.trigger()
        node.get_logger().info("timer callback triggered guard condition")

    node.create_timer(timer_period_sec=2, callback=timer_callback)
    guard_condition = node.create_guard_condition(guard_condition_callback)
    while rclpy.ok():
        node.get_logger().info("waiting for 'spin_once' to finish...")
        executor.spin_once()
        node.get_logger().info("...'spin_once' finished!\n")


if __name__ == "__main__":
    main()
