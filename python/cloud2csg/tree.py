"""CSG trees as nested objects, as in ``Model.tree``.

>>> from cloud2csg import Leaf, Union, Difference
>>> tree = Difference(Union(Leaf("plate"), Leaf("boss")), Leaf("bore"))
>>> print(tree)
(plate | boss) - bore
>>> tree == (Leaf("plate") | Leaf("boss")) - Leaf("bore")
True

Nodes are immutable. No function recurses, so trees may be as deep as memory allows.
"""
from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import ClassVar

__all__ = ["Complement", "Difference", "Empty", "Full", "Intersection", "Leaf", "Node", "Union"]


class Node:
    """A subtree: a Leaf, Empty, Full, Complement, Union, Intersection or Difference.

    ``a | b`` is Union(a, b), ``a & b`` Intersection(a, b), ``a - b`` Difference(a, b), ``~a`` Complement(a). Nested
    unions become one union, and nested intersections one intersection. Nodes are equal if they have equal text forms,
    with operands in the same order.
    """

    __slots__ = ("_children",)
    #: Name of the operation in model files.
    operation: ClassVar[str] = ""
    _symbol: ClassVar[str] = ""
    _children: tuple[Node, ...]

    def __init__(self, *children: Node) -> None:
        for child in children:
            if not isinstance(child, Node):
                raise TypeError(f"{type(self).__name__}: expected tree nodes, found {child!r}")
        object.__setattr__(self, "_children", children)

    @property
    def children(self) -> tuple[Node, ...]:
        """The operands, in order; empty for a leaf."""
        return self._children

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("tree nodes are immutable")

    def __or__(self, other: Node) -> Union:
        return _chain(Union, self, other)

    def __and__(self, other: Node) -> Intersection:
        return _chain(Intersection, self, other)

    def __sub__(self, other: Node) -> Difference:
        return Difference(self, other)

    def __invert__(self) -> Complement:
        return Complement(self)

    def walk(self) -> Iterator[Node]:
        """All nodes of the subtree, children before their parent, this one last."""
        pending: list[tuple[Node, int]] = [(self, 0)]
        while pending:
            node, done = pending.pop()
            if done == len(node._children):
                yield node
            else:
                pending.append((node, done + 1))
                pending.append((node._children[done], 0))

    def leaves(self) -> Iterator[Leaf]:
        """The primitives of the subtree from left to right, with repetitions."""
        return (node for node in self.walk() if isinstance(node, Leaf))

    def _key(self) -> tuple[object, ...]:
        return tuple((type(node), len(node._children), getattr(node, "id", "")) for node in self.walk())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Node) and (self is other or self._key() == other._key())

    def __hash__(self) -> int:
        return hash(self._key())

    def __repr__(self) -> str:
        return _written(self, lambda node: [
            f"{type(node).__name__}({node._argument()}", *_separated(node._children, ", "), ")"])

    def _argument(self) -> str:
        return ""

    def __str__(self) -> str:
        """The text form that Model(..., tree=text) reads: | union, & intersection, - difference, ~ complement."""
        return _written(self, lambda node: node._text())

    def _text(self) -> list[str | Node]:
        """Texts and children, in the order of the text form."""
        parts: list[str | Node] = []
        for index, child in enumerate(self._children):
            parts.append(self._symbol if index > 0 or len(self._children) == 1 else "")
            parts += ["(", child, ")"] if _needs_parentheses(self, child, index) else [child]
        return parts or [self._symbol]

    def __reduce__(self) -> tuple[object, ...]:
        return (from_postfix, (postfix(self),))


class Leaf(Node):
    """A primitive of the model, by its id."""

    __slots__ = ("_id",)
    __match_args__ = ("id",)
    operation = "primitive"
    _id: str

    def __init__(self, id: str) -> None:  # noqa: A002: the word of model files
        super().__init__()
        if not isinstance(id, str):
            raise TypeError(f"Leaf: expected the id of a primitive, found {id!r}")
        object.__setattr__(self, "_id", id)

    @property
    def id(self) -> str:
        """Id of the primitive."""
        return self._id

    def _argument(self) -> str:
        return repr(self._id)

    def _text(self) -> list[str | Node]:
        is_plain = self._id not in ("", "empty", "full") and all(
            c.isalnum() or c in "_.:" or not c.isascii() for c in self._id)
        if is_plain:
            return [self._id]
        escaped = self._id.replace("\\", "\\\\").replace('"', '\\"')
        return [f'"{escaped}"']


class Empty(Node):
    """The empty solid."""

    __slots__ = ()
    operation = "empty"
    _symbol = "empty"

    def __init__(self) -> None:
        super().__init__()


class Full(Node):
    """All of space."""

    __slots__ = ()
    operation = "full"
    _symbol = "full"

    def __init__(self) -> None:
        super().__init__()


class Complement(Node):
    """All of space except its child."""

    __slots__ = ()
    __match_args__ = ("child",)
    operation = "complement"
    _symbol = "~"

    def __init__(self, child: Node) -> None:
        super().__init__(child)

    @property
    def child(self) -> Node:
        """The solid whose complement this is."""
        return self._children[0]


class Union(Node):
    """Union of two or more children."""

    __slots__ = ()
    __match_args__ = ("children",)
    operation = "union"
    _symbol = " | "

    def __init__(self, *children: Node) -> None:
        _require_two(type(self), children)
        super().__init__(*children)


class Intersection(Node):
    """Intersection of two or more children."""

    __slots__ = ()
    __match_args__ = ("children",)
    operation = "intersection"
    _symbol = " & "

    def __init__(self, *children: Node) -> None:
        _require_two(type(self), children)
        super().__init__(*children)


class Difference(Node):
    """The first child without the second."""

    __slots__ = ()
    __match_args__ = ("first", "second")
    operation = "difference"
    _symbol = " - "

    def __init__(self, first: Node, second: Node) -> None:
        super().__init__(first, second)

    @property
    def first(self) -> Node:
        """The solid from which ``second`` is subtracted."""
        return self._children[0]

    @property
    def second(self) -> Node:
        """The solid that is subtracted."""
        return self._children[1]


def _require_two(kind: type[Node], children: Sequence[Node]) -> None:
    if len(children) < 2:
        raise TypeError(f"{kind.__name__}: expected two children or more, found {len(children)}")


def _needs_parentheses(parent: Node, child: Node, index: int) -> bool:
    """As in the library: parentheses between different operations, but none within chains of one operation."""
    is_chain = type(child) is type(parent) and not (isinstance(child, Difference) and index == 1)
    return len(child.children) > 1 and not is_chain


def _chain(kind, first, second):
    if not isinstance(second, Node):
        return NotImplemented
    parts = [*(first.children if isinstance(first, kind) else (first,)),
             *(second.children if isinstance(second, kind) else (second,))]
    return kind(*parts)


def _separated(nodes: Sequence[Node], separator: str) -> list[str | Node]:
    parts: list[str | Node] = []
    for node in nodes:
        parts += [separator, node] if parts else [node]
    return parts


def _written(root: Node, parts_of: Callable[[Node], list[str | Node]]) -> str:
    """Joins the parts of a node; child nodes are replaced by their own parts."""
    texts: list[str] = []
    pending: list[str | Node] = [root]
    while pending:
        part = pending.pop()
        if isinstance(part, str):
            texts.append(part)
        else:
            pending.extend(reversed(parts_of(part)))
    return "".join(texts)


_KINDS: dict[str, type[Node]] = {
    kind.operation: kind for kind in (Leaf, Empty, Full, Complement, Union, Intersection, Difference)}


def postfix(root: Node) -> list[tuple[str, str]]:
    """(operation, id of a leaf or '') of each node of the binary tree, children first: the form of the library."""
    nodes: list[tuple[str, str]] = []
    pending: list[tuple[Node, int]] = [(root, 0)]
    while pending:
        node, done = pending.pop()
        if not node.children:
            nodes.append((node.operation, node.id if isinstance(node, Leaf) else ""))
            continue
        if done >= 2 or (done == 1 and isinstance(node, Complement)):
            nodes.append((node.operation, ""))
        if done < len(node.children):
            pending.append((node, done + 1))
            pending.append((node.children[done], 0))
    return nodes


def from_postfix(nodes: Sequence[tuple[str, str]]) -> Node:
    """The nested objects of a binary tree: chains of the same union or intersection become one node."""
    stack: list[tuple[type[Node], list[Node]]] = []
    for operation, name in nodes:
        kind = _KINDS[operation]
        if kind is Leaf:
            stack.append((Leaf, [Leaf(name)]))
        elif kind in (Empty, Full):
            stack.append((kind, [kind()]))
        elif kind is Complement:
            stack.append((Complement, [Complement(_closed(stack.pop()))]))
        else:
            second = stack.pop()
            stack.append(_joined(kind, stack.pop(), second))
    return _closed(stack.pop())


def _closed(part: tuple[type[Node], list[Node]]) -> Node:
    """The node of a chain that is still being collected; otherwise the single node."""
    kind, nodes = part
    return kind(*nodes) if kind in (Union, Intersection) else nodes[0]


def _joined(kind: type[Node], first: tuple[type[Node], list[Node]],
            second: tuple[type[Node], list[Node]]) -> tuple[type[Node], list[Node]]:
    if kind is Difference:
        return Difference, [Difference(_closed(first), _closed(second))]
    nodes = first[1] if first[0] is kind else [_closed(first)]
    nodes.extend(second[1] if second[0] is kind else [_closed(second)])
    return kind, nodes
