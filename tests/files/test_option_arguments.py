"""What a command line gives, as options."""

import argparse

import pytest
from rsibr.rsibr_addon.command_line.options import add_options_of, given_of
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode
from rsibr.rsibr_addon.settings.lobe_stack import StackComparison
from rsibr.rsibr_addon.settings.radiance_views import ViewsComparison

OWNERS = {"views": ViewsComparison, "stacks": StackComparison}


def parsed(text: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    add_options_of(parser, OWNERS)
    return parser.parse_args(text.split())


@pytest.mark.parametrize("text", ["--mode paper,texel", "--mode paper --mode texel"])
def test_several_values_are_given_at_once_or_one_by_one(text: str) -> None:
    assert given_of(parsed(text), OWNERS, "views").modes == (Mode.PAPER, Mode.TEXEL)


def test_what_is_not_given_is_the_owner_s_default() -> None:
    assert given_of(parsed("--seed 3"), OWNERS, "views") == ViewsComparison(seed=3)
    assert given_of(parsed("--seed 3 --rings 8"), OWNERS, "stacks") == StackComparison(seed=3, rings=8)


def test_an_option_of_others_is_refused() -> None:
    with pytest.raises(RangeError, match="The option --rings is for stacks, not for views: omit it"):
        given_of(parsed("--rings 8"), OWNERS, "views")
