"""Share of contacts that a method misses: what the table and the figure of them both show."""


def missed_share(data):
    """Share of the runs that came to their end which miss the contact, NaN where none did.

    Parameters
    ----------
    data : xarray.Dataset
        Of `missed_contacts.missed_contacts`, of one method or of all.

    Returns
    -------
    xarray.DataArray
    """
    failed = data["passage_count"].sel(contact_outcome="failed")
    found = data["passage_count"].sel(contact_outcome="found")
    ended = data["passages"] - failed
    return 1 - found / ended.where(ended > 0)
