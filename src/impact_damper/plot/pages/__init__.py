"""Pages in HTML: text, numbers with their sources, and figures."""
