"""Errors and work of the methods compared, on a test case (scene) of the configuration."""

from chatterjee1995.methods.accuracy import ComparisonScene, error_against_work


def accuracy(
    system, damper, *, name, frequency, state, periods, motion, accuracy, settings, references
):
    """Return the errors and the work of each method on a scene.

    `references` holds the references of all scenes that are not chaotic, by name, and `settings`
    are those of `error_against_work`.
    """
    scene = ComparisonScene(name, system, damper, frequency, state, periods, motion, accuracy)
    return error_against_work(scene, settings, references.get(name))
