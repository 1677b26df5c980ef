"""Write the reference in docs/commands.md from the help of the commands' options."""

import argparse
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from rsibr.rsibr_addon.command_line.commands import parser
from rsibr.rsibr_addon.command_line.parser import Parser

PAGE = Path(__file__).parents[1] / "docs" / "commands.md"
BEGIN = "<!-- made from the options' help by .ci/docs_commands.py -->\n"


def written_anew(page: str) -> str:
    """The page with the reference of today's options in place of its own."""
    told, begin, _ = page.partition(BEGIN)
    assert begin, f"{PAGE} has lost the line {BEGIN}"
    return f"{told}{begin}\n" + "\n".join(_reference())


def _reference() -> Iterator[str]:
    commands = list(_commands(parser()))
    shared = _common([command for _, command in commands])
    yield "## Options of every command\n"
    yield from _table(commands[0][1], [each for each in commands[0][1]._actions if _name(each) in shared], [])
    for family, members in groupby(commands, lambda command: command[0].rpartition(" ")[0]):
        yield from _family(family, list(members), shared)


def _family(family: str, members: list[tuple[str, Parser]], shared: list[str]) -> Iterator[str]:
    """Commands such as `rsibr bake KIND`: what they have in common first, then each with the rest."""
    told, first = shared, members[0][1]
    if len(family.split()) > 1:
        told = _common([command for _, command in members])
        yield f"## Options of every {family}\n"
        yield from _table(first, [each for each in first._actions if _name(each) in told], shared)
    for title, command in members:
        yield f"## {title}\n"
        yield f"{command.description}\n"
        yield f"```text\n{_usage(command, shared)}\n```\n"
        positionals, options, *groups = command._action_groups
        yield from _table(command, positionals._group_actions + options._group_actions, told)
        for group in groups:
            yield f"{group.title}:\n"
            yield from _table(command, group._group_actions, told)


def _common(commands: list[Parser]) -> list[str]:
    """Names of the options that all of these have, with the same words."""
    rows = [{_name(each): _row(command, each) for each in command._actions} for command in commands]
    return [name for name, row in rows[0].items() if all(other.get(name) == row for other in rows)]


def _commands(parent: Parser) -> Iterator[tuple[str, Parser]]:
    """All commands that do something, those of a family in turn, by what one types."""
    parent.declare()
    families = [action for action in parent._actions if isinstance(action, argparse._SubParsersAction)]
    if not families:
        yield parent.prog, parent
    for family in families:
        for command in family.choices.values():
            yield from _commands(command)


def _name(action: argparse.Action) -> str:
    return action.option_strings[-1] if action.option_strings else action.dest


def _usage(command: argparse.ArgumentParser, shared: list[str]) -> str:
    """What must and what may be given, in lines of one width, whatever the terminal's."""
    formatter = argparse.HelpFormatter(command.prog, width=100)
    own = [action for action in command._actions if _name(action) not in shared]
    formatter.add_usage(None, own, command._mutually_exclusive_groups, prefix="")
    return formatter.format_help().strip()


def _table(
    command: argparse.ArgumentParser, actions: list[argparse.Action], without: list[str]
) -> Iterator[str]:
    rows = [_row(command, action) for action in actions if _name(action) not in without]
    if rows:
        yield "| option | what |\n|---|---|"
        yield from rows
        yield ""


def _row(command: argparse.ArgumentParser, action: argparse.Action) -> str:
    formatter = argparse.HelpFormatter(command.prog, width=100)
    invocation = formatter._format_action_invocation(action)
    return f"| `{_cell(invocation)}` | {_cell(formatter._expand_help(action))} |"


def _cell(text: str) -> str:
    return text.replace("|", r"\|")


if __name__ == "__main__":
    PAGE.write_text(written_anew(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
