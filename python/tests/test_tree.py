"""Trees as nested objects."""
import pickle

import pytest

import cloud2csg
from cloud2csg import Complement, Difference, Empty, Full, Intersection, Leaf, Union

A, B, C = Leaf("a"), Leaf("b"), Leaf("c")
IDS = ["a", "b", "c", "with space", 'quote"and\\', "empty", "ünïcode", "x.y:z_1"]


def model(tree):
    return cloud2csg.Model([cloud2csg.Primitive(name, cloud2csg.Sphere(1)) for name in IDS], tree)


TREES = [A, Empty(), Full(), ~A, A | B, A & B, A - B, A | B | C, (A & B) | C, A - (B | C), (A - B) - C, A - (B - C),
         ~(A | B) & C, ~~A, Leaf("with space") | Leaf('quote"and\\'), Leaf("empty") - Leaf("ünïcode"),
         Leaf("x.y:z_1") & Full(), Union(A & B, C - A, ~B, A), A & (B | (C & A))]


@pytest.mark.parametrize("tree", TREES, ids=str)
def test_there_and_back(tree):
    held = model(tree)
    assert held.tree == tree
    assert str(tree) == held.to_text()
    assert model(str(tree)).tree == tree
    assert cloud2csg.Model.from_json(held.to_json()).tree == tree
    assert eval(repr(tree), vars(cloud2csg)) == tree
    assert pickle.loads(pickle.dumps(tree)) == tree and hash(pickle.loads(pickle.dumps(tree))) == hash(tree)


def test_operators():
    assert A | B | C == Union(A, B, C) == (A | (B | C))
    assert A & B & C == Intersection(A, B, C)
    assert (A - B) == Difference(A, B) and ~A == Complement(A)
    assert A | B != B | A and A != "a"
    with pytest.raises(TypeError):
        A | "b"


def test_chains_of_the_library_become_one_node():
    assert model(Union(Union(A, B), C)).tree == Union(A, B, C)
    assert model(Union(A, Union(B, C))).tree == Union(A, B, C)
    assert model(Union(Union(A, B), Intersection(B, Intersection(C, A)))).tree == Union(A, B, Intersection(B, C, A))


def test_matching_and_walking():
    match (A | B) - C:
        case Difference(Union(children), second):
            assert children == (A, B) and second == C
        case _:
            pytest.fail("no match")
    tree = (A | B) - ~A
    assert [leaf.id for leaf in tree.leaves()] == ["a", "b", "a"]
    assert [type(node).__name__ for node in tree.walk()] == ["Leaf", "Leaf", "Union", "Leaf", "Complement", "Difference"]
    assert (tree.first, tree.second.child, tree.children[0].children) == (A | B, A, (A, B))


def test_nodes_do_not_change():
    with pytest.raises(AttributeError):
        A.id = "b"
    with pytest.raises(AttributeError):
        (A | B).children = ()


def test_wrong_nodes():
    with pytest.raises(TypeError, match="two children or more, found 1"):
        Union(A)
    with pytest.raises(TypeError, match="expected tree nodes, found 'b'"):
        Difference(A, "b")
    with pytest.raises(TypeError, match="id of a primitive"):
        Leaf(3)
    with pytest.raises(cloud2csg.Error, match='expected the id of a primitive, found "nobody"'):
        model(A - Leaf("nobody"))
    with pytest.raises(cloud2csg.Error, match="column"):
        model("a |")
    with pytest.raises(TypeError, match="expected a tree node"):
        model(3)


def test_deep_trees():
    tree = A
    for i in range(50_000):
        tree = tree - B if i % 2 else tree | C
    held = model(tree)
    assert held.tree == tree and held.depth == 50_000 and len(str(tree)) > 100_000
    assert repr(tree).startswith("Difference(")
