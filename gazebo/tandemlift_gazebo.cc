// The body of a flight in Gazebo 11: a plugin of the model `tandemlift`, led step by step over UDP on loopback.
//
// The model has the links `payload` and `quadrotor_1` ... `quadrotor_N`, and a fixed joint `joint_i` from the payload
// (parent) to each quadrotor (child). The origin of `payload` is the payload's centre of mass.
//
// Modes
//   alone    no pilot: rotors off, the world goes on in real time and never waits (unless <wait> is set)
//   led      a pilot has said hello: before every step the world waits for its message
//   holding  the pilot was silent for <patience> seconds: its last thrusts act for <hold> seconds more, then alone
// While the world waits its time stands still. A new hello is heard in every mode.
//
// Settings of the <plugin>, all of them optional
//   <port>      UDP port on 127.0.0.1; 19110
//   <wait>      true: wait for the first pilot, at most a minute, before the first step; false
//   <patience>  s of real time after which a silent pilot is given up, 0 for never; 1
//   <hold>      s of simulated time for which its last thrusts are held; 0.1
//   <stay>      false: the server ends when the pilot says goodbye or the process that started it has ended; true
//
// Messages are a Header and a fixed number of doubles, both little-endian, N quadrotors:
//   HELLO    pilot   flags (1: place the vehicle, 2: in real time), step [s], State (13), then of all 4 N rotors
//                    x [m], y [m] from the quadrotor's centre of mass, torque over thrust [m] (signed)
//   WELCOME  plugin  as STATE
//   STEP     pilot   thrusts (4 N) [N]; at the vehicle's centre of mass force [N, world] and moment [N m, body]; at the
//                    payload's origin, likewise; on every quadrotor at its centre of mass force x, y, z (each of all N)
//                    and moment, likewise
//   STATE    plugin  time [s], step [s], mass [kg]; State after the step; what was felt at its start: specific force at
//                    the payload's origin (3), force x, y, z and torque x, y, z of every quadrotor on the payload at its
//                    joint (6 N, body), force of contacts (3, world); force [N, world] and moment [N m, body] about the
//                    centre of mass of pushes by topic over the step
//   BYE      pilot   nothing
//   REFUSE   plugin  why (enum Why)
// State is position and velocity [world] of the vehicle's centre of mass, quaternion w, x, y, z, rates [rad/s, body].
// Gazebo's step is v' = v + h a, then x' = x + h v': its positions are half a step ahead of its velocities. In a State
// they are taken back by h v / 2, to the time of the velocities, and where the vehicle is placed they are put ahead by
// as much. What is told is then of second order in h, not of first.
// STEP k is answered by STATE k. A STEP that comes again gets the same answer again, and moves nothing.
//
// A person pushes on the topic ~/tandemlift/push (gazebo.msgs.GzString), in simulated time:
//   force FX FY FZ [point X Y Z] [duration S]   N in world axes, m in body axes from the vehicle's centre of mass, s
//   off                                         ends all pushes

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gazebo/common/common.hh>
#include <gazebo/msgs/msgs.hh>
#include <gazebo/physics/physics.hh>
#include <gazebo/transport/transport.hh>

namespace tandemlift {

using ignition::math::Pose3d;
using ignition::math::Quaterniond;
using ignition::math::Vector3d;
using Clock = std::chrono::steady_clock;

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "messages are little-endian");

constexpr std::uint32_t MAGIC = 0x5a474c54;  // "TLGZ"
constexpr std::uint16_t VERSION = 1;
constexpr int DEFAULT_PORT = 19110;
constexpr double LONGEST_WAIT = 60.0;   // s, for the first pilot
constexpr int GLANCE = 50;              // ms, between looks at whether the server is to end
constexpr double NO_CONTACT = 1e-7;     // N, below which the force of contacts is rounding
constexpr double LARGEST_PUSH = 1e4;    // N
constexpr double LONGEST_PUSH = 3600.0; // s

enum Kind : std::uint16_t { HELLO = 1, WELCOME, STEP, STATE, BYE, REFUSE };
enum Why { OTHER_VERSION = 1, OTHER_COUNT, MALFORMED, NOT_FINITE, OVER };
enum Flag { PLACE = 1, REAL_TIME = 2 };

struct Header {
    std::uint32_t magic;
    std::uint16_t version;
    std::uint16_t kind;
    std::uint32_t session;
    std::uint32_t count;
    std::uint64_t sequence;
};
static_assert(sizeof(Header) == 24, "the header has no gaps");

struct Push {
    Vector3d force;   // N, world axes
    Vector3d point;   // m, body axes, from the vehicle's centre of mass
    double left;      // s
};

// The push that a text says; throws std::invalid_argument with what is wrong.
Push ReadPush(const std::string& text) {
    Push push{Vector3d::Zero, Vector3d::Zero, 1.0};
    std::istringstream words(text);
    bool forced = false;
    for (std::string word; words >> word;) {
        double x = 0.0, y = 0.0, z = 0.0;
        if (word == "force" && words >> x >> y >> z) {
            push.force.Set(x, y, z);
            forced = true;
        } else if (word == "point" && words >> x >> y >> z) {
            push.point.Set(x, y, z);
        } else if (!(word == "duration" && words >> push.left)) {
            throw std::invalid_argument("cannot read '" + word + "' and what follows");
        }
    }
    if (!forced) throw std::invalid_argument("no force is given");
    if (!(push.force.Length() <= LARGEST_PUSH)) throw std::invalid_argument("the force must be at most 10000 N");
    if (!(push.point.Length() <= 1e3)) throw std::invalid_argument("the point must be within 1000 m");
    if (!(push.left > 0.0 && push.left <= LONGEST_PUSH))
        throw std::invalid_argument("the duration must be more than 0 and at most 3600 s");
    return push;
}

// A socket on loopback that keeps the sender of what it heard last.
class Post {
  public:
    ~Post() {
        if (fd_ >= 0) close(fd_);
    }

    bool Open(int port) {
        fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        sockaddr_in own{};
        own.sin_family = AF_INET;
        own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        own.sin_port = htons(static_cast<std::uint16_t>(port));
        return fd_ >= 0 && bind(fd_, reinterpret_cast<sockaddr*>(&own), sizeof own) == 0;
    }

    // Wait up to some milliseconds for a message that begins with a Header of ours.
    bool Receive(int milliseconds) {
        pollfd waiting{fd_, POLLIN, 0};
        if (milliseconds > 0 && poll(&waiting, 1, milliseconds) <= 0) return false;
        socklen_t size = sizeof from_;
        const ssize_t got =
            recvfrom(fd_, buffer_, sizeof buffer_, MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from_), &size);
        if (got < static_cast<ssize_t>(sizeof header)) return got >= 0 && Receive(0);
        std::memcpy(&header, buffer_, sizeof header);
        const std::size_t rest = got - sizeof header;
        whole = rest % sizeof(double) == 0;
        numbers.resize(rest / sizeof(double));
        std::memcpy(numbers.data(), buffer_ + sizeof header, numbers.size() * sizeof(double));
        return header.magic == MAGIC || Receive(0);
    }

    // Answer the sender of the message heard last.
    void Send(const Header& head, const std::vector<double>& values) const {
        static thread_local std::vector<char> out;
        out.resize(sizeof head + values.size() * sizeof(double));
        std::memcpy(out.data(), &head, sizeof head);
        std::memcpy(out.data() + sizeof head, values.data(), values.size() * sizeof(double));
        sendto(fd_, out.data(), out.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&from_), sizeof from_);
    }

    Header header{};              // of what was heard last
    std::vector<double> numbers;  // that followed it
    bool whole = false;           // whether nothing but doubles followed it

  private:
    int fd_ = -1;
    sockaddr_in from_{};
    char buffer_[65536];
};

bool Finite(const std::vector<double>& values) {
    for (double value : values)
        if (!std::isfinite(value)) return false;
    return true;
}

Vector3d Three(const std::vector<double>& values, std::size_t at, std::size_t apart = 1) {
    return {values[at], values[at + apart], values[at + 2 * apart]};
}

void Put(std::vector<double>& values, const Vector3d& v) { values.insert(values.end(), {v.X(), v.Y(), v.Z()}); }

// The rotation by a vector of an angle [rad] about its direction, world axes.
Quaterniond Turn(const Vector3d& angle) {
    const double size = angle.Length();
    return size > 0.0 ? Quaterniond(angle / size, size) : Quaterniond::Identity;
}

// The links and joints of the vehicle: forces in, motion and joint wrenches out.
class Vehicle {
  public:
    // Throws std::runtime_error with what is missing in the model.
    void Load(const gazebo::physics::ModelPtr& model) {
        model_ = model;
        payload_ = Link("payload");
        for (int i = 1; model->GetLink("quadrotor_" + std::to_string(i)); ++i) {
            quadrotors_.push_back(Link("quadrotor_" + std::to_string(i)));
            const auto joint = model->GetJoint("joint_" + std::to_string(i));
            if (!joint || joint->GetParent() != payload_ || joint->GetChild() != quadrotors_.back())
                throw std::runtime_error("no joint_" + std::to_string(i) + " from payload to its quadrotor");
            joint->SetProvideFeedback(true);
            joints_.push_back(joint);
        }
        if (quadrotors_.empty()) throw std::runtime_error("no link quadrotor_1");
        links_.push_back(payload_);
        links_.insert(links_.end(), quadrotors_.begin(), quadrotors_.end());
        Vector3d moment;
        for (const auto& link : links_) {
            offsets_.push_back(payload_->WorldPose().Inverse() * link->WorldPose());
            const auto& pose = offsets_.back();
            moment += link->GetInertial()->Mass() * (pose.Pos() + pose.Rot() * link->GetInertial()->CoG());
            mass_ += link->GetInertial()->Mass();
        }
        center_ = moment / mass_;
    }

    std::size_t Count() const { return quadrotors_.size(); }
    double Mass() const { return mass_; }
    const Vector3d& Center() const { return center_; }  // of mass, in the payload's frame [m]

    // Put the vehicle into a State, as one rigid body, where a step takes some seconds.
    void Place(const std::vector<double>& values, std::size_t at, double step) {
        const Vector3d velocity = Three(values, at + 3), position = Three(values, at) + 0.5 * step * velocity;
        Quaterniond attitude(values[at + 6], values[at + 7], values[at + 8], values[at + 9]);
        attitude.Normalize();
        const Vector3d rates = attitude * Three(values, at + 10);
        attitude = Turn(0.5 * step * rates) * attitude;
        model_->ResetPhysicsStates();
        const Pose3d base(position - attitude * center_, attitude);
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const Pose3d pose = base * offsets_[i];
            links_[i]->SetWorldPose(pose);
            const Vector3d arm = pose.Pos() + pose.Rot() * links_[i]->GetInertial()->CoG() - position;
            links_[i]->SetLinearVel(velocity + rates.Cross(arm));  // of the link's centre of mass
            links_[i]->SetAngularVel(rates);
        }
    }

    // Begin a step: no force acts, and what its accelerations are measured from is kept.
    void Begin() {
        applied_ = Vector3d::Zero;
        before_ = payload_->WorldPose().Rot();
        payload_velocity_ = payload_->WorldLinearVel();
        velocities_.clear();
        for (const auto& link : links_) velocities_.push_back(link->WorldCoGLinearVel());
    }

    // Thrust [N] along body z and moment [N m, body] of quadrotor i's rotors.
    void Lift(std::size_t i, double thrust, const Vector3d& moment) {
        quadrotors_[i]->AddRelativeForce({0.0, 0.0, thrust});
        quadrotors_[i]->AddRelativeTorque(moment);
        applied_ += quadrotors_[i]->WorldPose().Rot() * Vector3d(0.0, 0.0, thrust);
    }

    // Force [N, world] at quadrotor i's centre of mass, and moment [N m, body].
    void Load(std::size_t i, const Vector3d& force, const Vector3d& moment) {
        quadrotors_[i]->AddForce(force);
        quadrotors_[i]->AddRelativeTorque(moment);
        applied_ += force;
    }

    // Force [N, world] at a point of the payload [m, from its origin], and moment [N m, body].
    void Load(const Vector3d& force, const Vector3d& moment, const Vector3d& point) {
        payload_->AddForce(force);
        payload_->AddRelativeTorque(
            moment + (point - payload_->GetInertial()->CoG()).Cross(before_.RotateVectorReverse(force)));
        applied_ += force;
    }

    // A push at a point from the centre of mass; the moment that it makes about there [N m, body].
    Vector3d Pushed(const Push& push) {
        Load(push.force, Vector3d::Zero, center_ + push.point);
        return push.point.Cross(before_.RotateVectorReverse(push.force));
    }

    // Append the State, where a step takes some seconds.
    void Tell(std::vector<double>& out, double step) const {
        const Vector3d rates = payload_->WorldAngularVel(), velocity = Velocity();
        const Quaterniond attitude = Turn(-0.5 * step * rates) * payload_->WorldPose().Rot();
        Put(out, Mean([](const auto& link) { return link->WorldCoGPose().Pos(); }) - 0.5 * step * velocity);
        Put(out, velocity);
        out.insert(out.end(), {attitude.W(), attitude.X(), attitude.Y(), attitude.Z()});
        Put(out, attitude.RotateVectorReverse(rates));
    }

    // Append what was felt over a step of some seconds, in the body axes at its start.
    void Feel(std::vector<double>& out, double step, const Vector3d& gravity) const {
        const Vector3d acceleration = (payload_->WorldLinearVel() - payload_velocity_) / step;
        Put(out, before_.RotateVectorReverse(acceleration - gravity));
        const std::size_t N = joints_.size(), at = out.size();
        out.resize(at + 6 * N);
        const Quaterniond back = before_.Inverse() * payload_->WorldPose().Rot();  // Gazebo turns them by the end's
        for (std::size_t i = 0; i < N; ++i) {
            // body2Force is what the child, a quadrotor, puts on its parent, in the child's axes, torque at the joint
            const auto felt = joints_[i]->GetForceTorque(0);
            const Vector3d force = back * felt.body2Force, torque = back * felt.body2Torque;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                out[at + axis * N + i] = force[axis];
                out[at + (3 + axis) * N + i] = torque[axis];
            }
        }
        // what else changes the momentum is contact (or a wrench that someone applies in the client)
        const Vector3d contact = mass_ * (Change() / step - gravity) - applied_;
        Put(out, contact.Length() < NO_CONTACT ? Vector3d::Zero : contact);
    }

  private:
    gazebo::physics::LinkPtr Link(const std::string& name) const {
        const auto link = model_->GetLink(name);
        if (!link) throw std::runtime_error("no link " + name);
        return link;
    }

    // The mean of something of the links, weighed by their mass.
    template <typename Of>
    Vector3d Mean(Of of) const {
        Vector3d sum;
        for (const auto& link : links_) sum += link->GetInertial()->Mass() * of(link);
        return sum / mass_;
    }

    Vector3d Velocity() const {
        return Mean([](const auto& link) { return link->WorldCoGLinearVel(); });
    }

    // Of the velocity of the vehicle's centre of mass since the step began [m/s].
    Vector3d Change() const {
        Vector3d momentum;
        for (std::size_t i = 0; i < links_.size(); ++i)
            momentum += links_[i]->GetInertial()->Mass() * (links_[i]->WorldCoGLinearVel() - velocities_[i]);
        return momentum / mass_;
    }

    gazebo::physics::ModelPtr model_;
    gazebo::physics::LinkPtr payload_;
    std::vector<gazebo::physics::LinkPtr> quadrotors_, links_;
    std::vector<gazebo::physics::JointPtr> joints_;
    std::vector<Pose3d> offsets_;  // of links in the payload's frame
    Vector3d center_;
    double mass_ = 0.0;
    Vector3d applied_, payload_velocity_;  // of this step [N, world]; at its start [m/s]
    Quaterniond before_;
    std::vector<Vector3d> velocities_;     // of all links' centres of mass, at its start [m/s, world]
};

class TandemliftPlugin : public gazebo::ModelPlugin {
  public:
    ~TandemliftPlugin() override { ending_ = true; }

    void Load(gazebo::physics::ModelPtr model, sdf::ElementPtr settings) override {
        world_ = model->GetWorld();
        const int port = settings->Get<int>("port", DEFAULT_PORT).first;
        waiting_ = settings->Get<bool>("wait", false).first;
        patience_ = settings->Get<double>("patience", 1.0).first;
        hold_ = settings->Get<double>("hold", 0.1).first;
        stay_ = settings->Get<bool>("stay", true).first;
        try {
            vehicle_.Load(model);
        } catch (const std::runtime_error& error) {
            gzerr << "tandemlift: model " << model->GetName() << " has " << error.what() << "; the plugin rests\n";
            return;
        }
        if (!post_.Open(port)) {
            gzerr << "tandemlift: UDP port " << port << " is taken; the plugin rests\n";
            return;
        }
        Rest();
        heard_ = Clock::now();
        node_ = gazebo::transport::NodePtr(new gazebo::transport::Node());
        node_->Init(world_->Name());
        pushing_ = node_->Subscribe("~/tandemlift/push", &TandemliftPlugin::OnPush, this);
        using gazebo::event::Events;
        begin_ = Events::ConnectWorldUpdateBegin([this](const auto&) { Begin(); });
        end_ = Events::ConnectWorldUpdateEnd([this] { End(); });
        stop_ = Events::ConnectStop([this] { ending_ = true; });
        interrupt_ = Events::ConnectSigInt([this] { ending_ = true; });
        gzmsg << "tandemlift: " << vehicle_.Count() << " quadrotors, UDP port " << port << "\n";
    }

    void Reset() override {
        std::lock_guard<std::mutex> lock(pushes_mutex_);
        pushes_.clear();
    }

  private:
    enum class Mode { ALONE, LED, HOLDING };

    double StepSize() const { return world_->Physics()->GetMaxStepSize(); }

    // Before every step of the world, in the physics thread.
    void Begin() {
        due_ = false;
        while (!ending_) {
            const bool wait = (mode_ == Mode::LED && !due_) || waiting_;
            if (!post_.Receive(wait ? GLANCE : 0)) {
                if (!wait) break;
                GiveUp();
            } else if (Heard(); due_) {
                break;
            }
        }
        vehicle_.Begin();
        pushed_force_ = pushed_moment_ = Vector3d::Zero;
        if (mode_ == Mode::HOLDING && (held_ += StepSize()) > hold_) Rest();
        if (mode_ != Mode::ALONE) Act();
        ApplyPushes();
    }

    // After every step of the world, in the physics thread.
    void End() {
        if (mode_ == Mode::LED && due_) Answer(STATE);
    }

    // Give up a pilot that is silent for too long, or the wait for a first one.
    void GiveUp() {
        const double silent = std::chrono::duration<double>(Clock::now() - heard_).count();
        if (!stay_ && getppid() != parent_) {
            Leave();
            ending_ = true;
        } else if (mode_ == Mode::LED && patience_ > 0.0 && silent > patience_) {
            gzwarn << "tandemlift: the pilot is silent; its thrusts are held for " << hold_ << " s, then rotors off\n";
            mode_ = Mode::HOLDING;
            held_ = 0.0;
            std::fill(step_.begin() + 4 * vehicle_.Count(), step_.end(), 0.0);  // only rotors are held
            world_->Physics()->SetRealTimeUpdateRate(1.0 / StepSize());
        } else if (waiting_ && silent > LONGEST_WAIT) {
            waiting_ = false;
        }
    }

    // Rotors off, in real time.
    void Rest() {
        mode_ = Mode::ALONE;
        world_->Physics()->SetRealTimeUpdateRate(1.0 / StepSize());
    }

    void Leave() const { std::raise(SIGINT); }  // as if someone had ended the server

    void Heard() {
        const Header& head = post_.header;
        if (head.version != VERSION) return Refuse(OTHER_VERSION);
        if (head.count != vehicle_.Count()) return Refuse(OTHER_COUNT);
        if (!Finite(post_.numbers)) return Refuse(NOT_FINITE);
        const std::size_t N = vehicle_.Count(), size = post_.numbers.size();
        if (head.kind == HELLO) {
            const bool sound = post_.whole && size == 15 + 12 * N && post_.numbers[0] >= 0.0 && post_.numbers[0] < 4.0;
            return sound ? Welcome() : Refuse(MALFORMED);
        }
        if (mode_ != Mode::LED || head.session != session_) return head.kind == BYE ? void() : Refuse(OVER);
        if (head.kind == BYE) {
            gzmsg << "tandemlift: the pilot says goodbye; rotors off\n";
            Rest();
            if (!stay_) Leave();
        } else if (head.kind != STEP || !post_.whole || size != 10 * N + 12) {
            Refuse(MALFORMED);
        } else {
            heard_ = Clock::now();
            if (head.sequence == sequence_ + 1) {
                step_ = post_.numbers;
                ++sequence_;
                due_ = true;
            } else if (head.sequence == sequence_ && sequence_ > 0) {
                post_.Send(answer_, told_);
            }
        }
    }

    // A hello: a session that was heard once never begins again, so that a late copy changes nothing.
    void Welcome() {
        const Header& head = post_.header;
        if (mode_ == Mode::LED && head.session == session_ && sequence_ == 0) return post_.Send(answer_, told_);
        if (!sessions_.insert(head.session).second) return;
        session_ = head.session;
        sequence_ = 0;
        heard_ = Clock::now();
        const auto& said = post_.numbers;
        const int flags = static_cast<int>(said[0]);
        rotors_.assign(said.begin() + 15, said.end());
        step_.assign(10 * vehicle_.Count() + 12, 0.0);
        if (flags & PLACE) {
            Reset();
            vehicle_.Place(said, 2, StepSize());
        }
        mode_ = Mode::LED;
        waiting_ = due_ = false;
        world_->Physics()->SetRealTimeUpdateRate(flags & REAL_TIME ? 1.0 / StepSize() : 0.0);
        vehicle_.Begin();
        pushed_force_ = pushed_moment_ = Vector3d::Zero;
        Answer(WELCOME);
    }

    void Answer(Kind kind) {
        told_.clear();
        told_.insert(told_.end(), {world_->SimTime().Double(), StepSize(), vehicle_.Mass()});
        vehicle_.Tell(told_, StepSize());
        vehicle_.Feel(told_, StepSize(), world_->Gravity());
        Put(told_, pushed_force_);
        Put(told_, pushed_moment_);
        answer_ = Head(kind, sequence_);
        post_.Send(answer_, told_);
    }

    void Refuse(Why why) const { post_.Send(Head(REFUSE, post_.header.sequence), {static_cast<double>(why)}); }

    Header Head(Kind kind, std::uint64_t sequence) const {
        return {MAGIC, VERSION, kind, post_.header.session, static_cast<std::uint32_t>(vehicle_.Count()), sequence};
    }

    // Apply the pilot's last message.
    void Act() {
        const std::size_t N = vehicle_.Count(), loads = 4 * N + 12;
        vehicle_.Load(Three(step_, 4 * N), Three(step_, 4 * N + 3), vehicle_.Center());
        vehicle_.Load(Three(step_, 4 * N + 6), Three(step_, 4 * N + 9), Vector3d::Zero);
        for (std::size_t i = 0; i < N; ++i) {
            double thrust = 0.0;
            Vector3d moment;
            for (std::size_t j = 4 * i; j < 4 * i + 4; ++j) {
                const double x = rotors_[j], y = rotors_[4 * N + j], torque = rotors_[8 * N + j];
                thrust += step_[j];
                moment += Vector3d(y, -x, torque) * step_[j];
            }
            vehicle_.Lift(i, thrust, moment);
            vehicle_.Load(i, Three(step_, loads + i, N), Three(step_, loads + 3 * N + i, N));
        }
    }

    void ApplyPushes() {
        std::lock_guard<std::mutex> lock(pushes_mutex_);
        const double step = StepSize();
        for (auto push = pushes_.begin(); push != pushes_.end();) {
            pushed_force_ += push->force;
            pushed_moment_ += vehicle_.Pushed(*push);
            push->left -= step;
            push = push->left < 0.5 * step ? pushes_.erase(push) : push + 1;
        }
    }

    // In a thread of Gazebo's transport.
    void OnPush(ConstGzStringPtr& message) {
        std::lock_guard<std::mutex> lock(pushes_mutex_);
        if (message->data() == "off") {
            pushes_.clear();
            return;
        }
        try {
            pushes_.push_back(ReadPush(message->data()));
        } catch (const std::invalid_argument& error) {
            gzerr << "tandemlift: push '" << message->data() << "': " << error.what()
                  << "; say: force FX FY FZ [point X Y Z] [duration S]\n";
        }
    }

    gazebo::physics::WorldPtr world_;
    Vehicle vehicle_;
    Post post_;
    bool waiting_ = false, stay_ = true;
    const pid_t parent_ = getppid();
    double patience_ = 1.0, hold_ = 0.1, held_ = 0.0;
    Mode mode_ = Mode::ALONE;
    bool due_ = false;             // whether the pilot's message for this step is there
    std::uint32_t session_ = 0;
    std::uint64_t sequence_ = 0;   // of the last step taken
    std::set<std::uint32_t> sessions_;
    std::vector<double> rotors_, step_, told_;
    Header answer_{};
    Clock::time_point heard_;
    Vector3d pushed_force_, pushed_moment_;
    std::mutex pushes_mutex_;
    std::vector<Push> pushes_;
    std::atomic<bool> ending_{false};
    gazebo::transport::NodePtr node_;
    gazebo::transport::SubscriberPtr pushing_;
    gazebo::event::ConnectionPtr begin_, end_, stop_, interrupt_;
};

GZ_REGISTER_MODEL_PLUGIN(TandemliftPlugin)

}  // namespace tandemlift
