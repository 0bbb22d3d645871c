"""Other programs that integrate motions with contacts, each as its own documentation recommends."""
