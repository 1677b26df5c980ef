"""The mathematics: numpy and the standard library only. The specification of every shader."""
