"""Parameters of nodes: values, descriptions, files, and the services that read and set them."""
