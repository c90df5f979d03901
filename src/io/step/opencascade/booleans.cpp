#include "io/step/opencascade/booleans.hpp"

#include <BRepAlgoAPI_BooleanOperation.hxx>
#include <Message_ProgressIndicator.hxx>
#include <TopTools_ListOfShape.hxx>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>

namespace cloud2csg::brep {
namespace {

class StopIndicator : public Message_ProgressIndicator {
 public:
  explicit StopIndicator(std::stop_token stop) : stop_(std::move(stop)) {}

 protected:
  Standard_Boolean UserBreak() override { return stop_.stop_requested(); }
  void Show(const Message_ProgressScope& /*scope*/, const Standard_Boolean /*force*/) override {}

 private:
  std::stop_token stop_;
};

std::string first_alert(const BRepAlgoAPI_BooleanOperation& operation) {
  std::ostringstream text;
  operation.DumpErrors(text);
  std::string line = text.str();
  line = line.substr(0, line.find('\n'));
  return line.empty() ? "it gave no reason" : line;
}

Bodies run_boolean(BOPAlgo_Operation kind, const TopTools_ListOfShape& objects, const TopTools_ListOfShape& tools,
                   const BooleanSettings& settings, const RunContext& run) {
  run.throw_if_stopped();
  BRepAlgoAPI_BooleanOperation operation;
  operation.SetOperation(kind);
  operation.SetArguments(objects);
  operation.SetTools(tools);
  operation.SetFuzzyValue(settings.fuzzy);
  operation.SetNonDestructive(true);
  operation.SetUseOBB(true);
  const Handle(StopIndicator) indicator = new StopIndicator(run.stop);
  operation.Build(indicator->Start());
  run.throw_if_stopped();
  if (operation.HasErrors() || !operation.IsDone()) throw BooleanFailure("the kernel says: " + first_alert(operation));
  return bodies_of(operation.Shape());
}

bool meet(const Body& a, const Body& b) {
  return !a.box.IsOut(b.box);
}

class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The root of a group is its first member.
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

struct Member {
  const Body* body;
  std::size_t operand;  ///< operand that the body belongs to
};

std::vector<Member> members_of(const std::vector<Bodies>& operands) {
  std::vector<Member> members;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    for (const Body& body : operands[i]) members.push_back({.body = &body, .operand = i});
  }
  return members;
}

/// Groups of bodies that meet bodies of other operands, directly or not, ordered by their first body.
std::vector<std::vector<Member>> meeting_groups(const std::vector<Member>& members) {
  Groups groups(members.size());
  for (std::size_t a = 0; a < members.size(); ++a) {
    for (std::size_t b = a + 1; b < members.size(); ++b) {
      if (members[a].operand != members[b].operand && meet(*members[a].body, *members[b].body)) groups.join(a, b);
    }
  }
  std::vector<std::vector<Member>> by_root(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) by_root[groups.root(i)].push_back(members[i]);
  std::erase_if(by_root, [](const std::vector<Member>& group) { return group.empty(); });
  return by_root;
}

TopTools_ListOfShape list_of(const Bodies& bodies) {
  TopTools_ListOfShape list;
  for (const Body& body : bodies) list.Append(body.shape);
  return list;
}

void append(Bodies& all, Bodies more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Applies one operation to bodies and tools that meet, or one operation for each tool.
Bodies apply(BOPAlgo_Operation kind, Bodies objects, const Bodies& tools, const BooleanSettings& settings,
             const RunContext& run) {
  if (!settings.one_by_one) return run_boolean(kind, list_of(objects), list_of(tools), settings, run);
  for (const Body& tool : tools) {
    if (objects.empty()) break;
    objects = run_boolean(kind, list_of(objects), list_of({tool}), settings, run);
  }
  return objects;
}

Bodies common_of_two(const Bodies& a, const Bodies& b, const BooleanSettings& settings, const RunContext& run) {
  Bodies result;
  const std::vector<Bodies> operands{a, b};
  for (const std::vector<Member>& group : meeting_groups(members_of(operands))) {
    TopTools_ListOfShape objects;
    TopTools_ListOfShape tools;
    for (const Member& member : group) (member.operand == 0 ? objects : tools).Append(member.body->shape);
    if (objects.IsEmpty() || tools.IsEmpty()) continue;
    append(result, run_boolean(BOPAlgo_COMMON, objects, tools, settings, run));
  }
  return result;
}

}  // namespace

Bodies unite(const std::vector<Bodies>& operands, const BooleanSettings& settings, const RunContext& run) {
  Bodies result;
  for (const std::vector<Member>& group : meeting_groups(members_of(operands))) {
    Bodies first{*group.front().body};
    Bodies others;
    for (std::size_t i = 1; i < group.size(); ++i) others.push_back(*group[i].body);
    append(result, others.empty() ? std::move(first) : apply(BOPAlgo_FUSE, std::move(first), others, settings, run));
  }
  return result;
}

Bodies intersect(const std::vector<Bodies>& operands, const BooleanSettings& settings, const RunContext& run) {
  Bodies result = operands.front();
  for (std::size_t i = 1; i < operands.size(); ++i) result = common_of_two(result, operands[i], settings, run);
  return result;
}

Bodies subtract(const Bodies& from, const std::vector<Bodies>& removed, const BooleanSettings& settings,
                const RunContext& run) {
  // Treats all removed bodies as one operand, because work arises only where they meet `from`.
  Bodies tools;
  for (const Bodies& bodies : removed) tools.insert(tools.end(), bodies.begin(), bodies.end());
  Bodies result;
  const std::vector<Bodies> operands{from, tools};
  for (const std::vector<Member>& group : meeting_groups(members_of(operands))) {
    Bodies kept;
    Bodies cutters;
    for (const Member& member : group) (member.operand == 0 ? kept : cutters).push_back(*member.body);
    append(result, kept.empty() || cutters.empty() ? std::move(kept)
                                                   : apply(BOPAlgo_CUT, std::move(kept), cutters, settings, run));
  }
  return result;
}

}  // namespace cloud2csg::brep
