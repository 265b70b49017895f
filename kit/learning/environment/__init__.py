"""Tasks as environments: many worlds as arrays, and Gymnasium's view of them."""
