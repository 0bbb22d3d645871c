"""Pages in HTML and Markdown: words, numbers with their sources, and figures."""
