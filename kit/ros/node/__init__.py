"""Nodes, and what a node creates: publishers, subscriptions, services, clients, timers."""
