// Reads a world by libsdformat and tells what is in it: a line for each thing, names first, then numbers.
// Poses are as libsdformat resolves them: position, then quaternion w, x, y, z.
#include <iostream>
#include <sdf/sdf.hh>

using Pose = ignition::math::Pose3d;

static void tell(const Pose &p) {
  std::cout << ' ' << p.Pos().X() << ' ' << p.Pos().Y() << ' ' << p.Pos().Z() << ' ' << p.Rot().W() << ' '
            << p.Rot().X() << ' ' << p.Rot().Y() << ' ' << p.Rot().Z();
}

static Pose resolved(const sdf::SemanticPose &semantic, const std::string &to = "") {
  Pose pose;
  for (const auto &error : semantic.Resolve(pose, to)) {
    std::cerr << error.Message() << '\n';
    std::exit(1);
  }
  return pose;
}

static void tell(const sdf::Geometry &g) {
  if (auto *box = g.BoxShape())
    std::cout << " box " << box->Size().X() << ' ' << box->Size().Y() << ' ' << box->Size().Z();
  if (auto *ball = g.SphereShape()) std::cout << " sphere " << ball->Radius();
  if (auto *rod = g.CylinderShape()) std::cout << " cylinder " << rod->Radius() << ' ' << rod->Length();
  if (auto *plane = g.PlaneShape())
    std::cout << " plane " << plane->Normal().X() << ' ' << plane->Normal().Y() << ' ' << plane->Normal().Z();
}

static void tell(const sdf::Link &link) {
  const auto &inertial = link.Inertial();
  const auto J = inertial.Moi();  // about the centre of mass, axes of the link
  std::cout << "link " << link.Name() << ' ' << inertial.MassMatrix().Mass();
  tell(resolved(link.SemanticPose()));
  std::cout << ' ' << inertial.Pose().Pos().X() << ' ' << inertial.Pose().Pos().Y() << ' ' << inertial.Pose().Pos().Z();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) std::cout << ' ' << J(i, j);
  std::cout << '\n';
  for (uint64_t i = 0; i < link.CollisionCount(); ++i) {
    const auto *c = link.CollisionByIndex(i);
    std::cout << "collision " << link.Name() << ' ' << c->Name();
    tell(*c->Geom());
    tell(resolved(c->SemanticPose()));
    std::cout << '\n';
  }
  for (uint64_t i = 0; i < link.VisualCount(); ++i) {
    const auto *v = link.VisualByIndex(i);
    std::cout << "visual " << link.Name() << ' ' << v->Name();
    tell(*v->Geom());
    tell(resolved(v->SemanticPose()));
    std::cout << '\n';
  }
}

static void tell(const sdf::Model &model) {
  std::cout << "model " << model.Name() << ' ' << model.Static();
  tell(resolved(model.SemanticPose()));
  std::cout << '\n';
  for (uint64_t i = 0; i < model.LinkCount(); ++i) tell(*model.LinkByIndex(i));
  for (uint64_t i = 0; i < model.JointCount(); ++i) {
    const auto *joint = model.JointByIndex(i);
    std::cout << "joint " << joint->Name() << ' ' << joint->ParentLinkName() << ' ' << joint->ChildLinkName() << ' '
              << (joint->Type() == sdf::JointType::FIXED ? "fixed" : "other");
    tell(resolved(joint->SemanticPose(), "__model__"));
    std::cout << '\n';
  }
}

int main(int, char **argv) {
  std::cout.precision(17);
  sdf::Root root;
  int bad = 0;
  auto strict = sdf::ParserConfig::GlobalConfig();
  strict.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  strict.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
  for (const auto &error : root.Load(argv[1], strict)) {
    std::cerr << error.Message() << '\n';
    bad = 1;
  }
  if (bad || root.WorldCount() != 1) return 1;
  const auto *world = root.WorldByIndex(0);
  const auto *physics = world->PhysicsByIndex(0);
  std::cout << "world " << world->Name() << ' ' << physics->EngineType() << ' ' << physics->MaxStepSize() << ' '
            << world->Gravity().X() << ' ' << world->Gravity().Y() << ' ' << world->Gravity().Z() << '\n';
  for (uint64_t i = 0; i < world->ModelCount(); ++i) tell(*world->ModelByIndex(i));
}
