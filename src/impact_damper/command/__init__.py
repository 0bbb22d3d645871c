"""The command `impact-damper`, and the YAML files that describe machines."""

import sys


def run():
    """Run the command. If a package is missing that only the command needs, exit with a message."""
    try:
        from impact_damper.command.command_line import run_app
    except ModuleNotFoundError as error:
        sys.exit(
            f"Error: the command needs the package {error.name}; install it with "
            "pip install 'impact-damper[command]'"
        )
    run_app()
