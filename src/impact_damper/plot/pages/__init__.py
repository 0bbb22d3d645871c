"""Pages in HTML and Markdown: text, numbers with their sources, and figures."""
