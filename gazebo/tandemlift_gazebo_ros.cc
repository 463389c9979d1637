// The body of a flight in Gazebo 11: a plugin of the model `tandemlift`, led step by step over ROS 1.
// The model: vehicle.hh. Modes, settings, and the numbers of a Command, Told and Rotors: body.hh. Pushes: push.hh.
//
// Settings of the <plugin>
//   <rotors>     Rotors (12 N numbers)
//   <namespace>  of topics and parameters, and with _ for / the node's name; /tandemlift/gazebo
//
// Lock-step is by stamp. Every state has a stamp of its own: 1 s at first, and a step more after each step or
// placement. A command says with its stamp which state it answers; one of any other stamp moves nothing. It is complete
// in itself, as there is no order between topics. The first node whose command is heard while nobody leads becomes the
// pilot; from then on the world waits. While it waits, its state is told again every 0.1 s, with the same stamp.
//
// Topics, below the namespace; frames as in docs/reference/flights.md
//   state            out  sensor_msgs/MultiDOFJointState, latched. All there is, to the last bit, in joints named
//                           base_link  transform and twist: State, linear velocity in world axes, rates in body axes
//                           imu        wrench: specific force [N for each kg, body]
//                           joint_I    wrench of quadrotor I on the payload [body]
//                           contact    wrench: force [world]
//                           push       wrench: of all pushes, force [world] and moment [body]
//                           then of what touches, such as floor/rotor_1_4, wall/guard_2, floor/beam: transform: where
//                           [world]; wrench: force x, the normal force
//   rotors           in   sensor_msgs/JointState: effort of every rotor_Q_R [N], of which a step is made
//   command          in   sensor_msgs/MultiDOFJointState: either wrenches (all of rotor_Q_R: force z; any of base_link,
//                         payload, quadrotor_Q: loads as in a Command), of which a step is made; or transform and twist
//                         of base_link as in `state`: place the vehicle there. No joints at all: goodbye
//   push             in   geometry_msgs/WrenchStamped at the centre of mass, world axes: held until the next, for 1 s
//   lead             in   std_msgs/Empty: the node that says it is the pilot from now on, whoever led
//   pilot            out  std_msgs/Header, latched: frame_id, the node that leads (empty when none does); the stamp of
//                         the state that it found
//   odometry         out  nav_msgs/Odometry, velocities in body axes
//   imu              out  sensor_msgs/Imu without orientation
//   joint_I/wrench, contact/force, push/wrench   out  geometry_msgs/WrenchStamped
//   /clock           out  rosgraph_msgs/Clock: the stamp
// Parameters, there too: step [s], mass [kg], quadrotors (their number); real_time, heeded when a pilot begins: whether
// the world is kept to real time, false if not set

#include <map>
#include <memory>
#include <set>

#include <ros/callback_queue.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Header.h>

#include "body.hh"
#include "ros_topics.hh"

namespace tandemlift {

using sensor_msgs::JointState;
using Values = std::vector<double>;

constexpr double LARGEST_COMMAND = 1e8;  // N
constexpr double PUSH_HELD = 1.0;        // s
constexpr std::chrono::milliseconds AGAIN{100};

// What is wrong with a message.
struct Unsound : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class TandemliftRosPlugin : public gazebo::ModelPlugin, Front {
  public:
    ~TandemliftRosPlugin() override {
        if (node_) ros::shutdown();
    }

    void Load(gazebo::physics::ModelPtr model, sdf::ElementPtr settings) override {
        try {
            body_.Load(model, settings);
            ReadRotors(settings->Get<std::string>("rotors", "").first);
            namespace_ = settings->Get<std::string>("namespace", "/tandemlift/gazebo").first;
        } catch (const std::runtime_error& error) {
            gzerr << "tandemlift: model " << model->GetName() << " has " << error.what() << "; the plugin rests\n";
            return;
        }
        std::string name = namespace_.substr(namespace_.find_first_not_of('/'));
        std::replace(name.begin(), name.end(), '/', '_');
        if (!ros::isInitialized())
            ros::init(ros::M_string(), name, ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
        if (!ros::master::check()) {
            gzerr << "tandemlift: no ROS master at " << ros::master::getURI() << "; the plugin rests\n";
            return;
        }
        Open();
        Lay();
        body_.Start(*this);
        gzmsg << "tandemlift: " << body_.Count() << " quadrotors, ROS master " << ros::master::getURI() << "\n";
    }

    void Reset() override { body_.EndPushes(); }

  private:
    void ReadRotors(const std::string& text) {
        std::istringstream words(text);
        for (double number; words >> number;) rotors_.push_back(number);
        if (rotors_.size() != 12 * body_.Count() || !Finite(rotors_))
            throw std::runtime_error("no <rotors> with " + std::to_string(12 * body_.Count()) + " numbers");
    }

    void Open() {
        node_.reset(new ros::NodeHandle(namespace_));
        node_->setCallbackQueue(&queue_);  // which the physics thread serves, step by step
        const auto hints = ros::TransportHints().tcpNoDelay();
        pilot_topic_ = node_->advertise<std_msgs::Header>("pilot", ROOM, true);
        topics_.Open(*node_, body_.Count());
        heard_.push_back(node_->subscribe("rotors", ROOM, &TandemliftRosPlugin::OnRotors, this, hints));
        heard_.push_back(node_->subscribe("command", ROOM, &TandemliftRosPlugin::OnCommand, this, hints));
        heard_.push_back(node_->subscribe("lead", ROOM, &TandemliftRosPlugin::OnLead, this, hints));
        heard_.push_back(node_->subscribe("push", ROOM, &TandemliftRosPlugin::OnPush, this, hints));
        node_->setParam("step", body_.StepSize());
        node_->setParam("mass", body_.Mass());
        node_->setParam("quadrotors", static_cast<int>(body_.Count()));
    }

    // Name all that may be commanded, by the place of its number in a Command.
    void Lay() {
        const std::size_t N = body_.Count();
        loads_ = {{"base_link", {4 * N, 1}}, {"payload", {4 * N + 6, 1}}};
        for (std::size_t i = 0; i < N; ++i) {
            const std::string number = std::to_string(i + 1);
            loads_["quadrotor_" + number] = {4 * N + 12 + i, N};
            for (std::size_t j = 0; j < 4; ++j) places_["rotor_" + number + "_" + std::to_string(j + 1)] = 4 * i + j;
        }
        tick_ = ros::Duration(body_.StepSize());
    }

    bool Hear(int milliseconds) override {
        if (told_.empty()) {
            TellStanding();
            TellPilot("");
        }
        if (!pilot_.empty() && !body_.Led()) TellPilot("");
        if (milliseconds > 0 && Clock::now() - published_ > AGAIN) Publish();
        return queue_.callOne(ros::WallDuration(1e-3 * milliseconds)) == ros::CallbackQueue::Called;
    }

    void Tell() override {
        body_.Tell(told_);
        stamp_ += tick_;
        Publish();
        topics_.TellTools();
    }

    void TellStanding() {
        body_.TellStanding(told_);
        Publish();
    }

    void Publish() {
        topics_.Tell(told_, stamp_);
        published_ = Clock::now();
    }

    void TellPilot(const std::string& name) {
        pilot_ = name;
        std_msgs::Header out;
        out.frame_id = name;
        out.stamp = stamp_;
        pilot_topic_.publish(out);
    }

    void Lead(const std::string& name) {
        body_.Lead(rotors_);
        body_.Pace(node_->param("real_time", false));
        TellPilot(name);
    }

    // Whether a node may speak: it leads, or nobody does and it will from now on.
    bool Leads(const std::string& name) {
        if (!body_.Led()) Lead(name);
        if (name == pilot_) {
            body_.Alive();
            return true;
        }
        if (refused_.insert(name).second)
            gzwarn << "tandemlift: " << name << " is not heard, as " << pilot_ << " leads; see the topic lead\n";
        return false;
    }

    // Heed a message from a pilot, unless it has come late.
    template <typename Message, typename Command>
    void Heed(const ros::MessageEvent<Message const>& event, Command command) {
        const std::string& name = event.getPublisherName();
        if (!Leads(name) || event.getMessage()->header.stamp != stamp_ || body_.Due()) return;
        try {
            command(*event.getMessage());
        } catch (const Unsound& error) {
            gzerr << "tandemlift: a message of " << name << " is refused: " << error.what() << "\n";
        }
    }

    void OnRotors(const ros::MessageEvent<JointState const>& event) {
        Heed(event, [this](const JointState& said) {
            if (said.effort.size() != said.name.size()) throw Unsound("it must have an effort for every name");
            Values values = None();
            std::size_t named = 0;
            for (std::size_t i = 0; i < said.name.size(); ++i) named += Thrust(values, said.name[i], said.effort[i]);
            Take(values, named);
        });
    }

    void OnCommand(const ros::MessageEvent<MultiDOFJointState const>& event) {
        const auto& said = *event.getMessage();
        if (said.joint_names.empty()) {
            if (body_.Led() && event.getPublisherName() == pilot_) body_.Goodbye();
            return;
        }
        Heed(event, [this](const MultiDOFJointState& said) { said.wrench.empty() ? Place(said) : Wrenches(said); });
    }

    Values None() const { return Values(10 * body_.Count() + 12, 0.0); }

    // Put in a rotor's thrust; whether there is such a rotor.
    bool Thrust(Values& values, const std::string& name, double thrust) const {
        const auto place = places_.find(name);
        if (place == places_.end()) throw Unsound("there is no " + name);
        values[place->second] = thrust;
        return true;
    }

    void Wrenches(const MultiDOFJointState& said) {
        if (said.wrench.size() != said.joint_names.size()) throw Unsound("it must have a wrench for every name");
        Values values = None();
        std::size_t named = 0;
        for (std::size_t i = 0; i < said.joint_names.size(); ++i) {
            const auto& wrench = said.wrench[i];
            const auto load = loads_.find(said.joint_names[i]);
            if (load == loads_.end()) {
                named += Thrust(values, said.joint_names[i], wrench.force.z);
                continue;
            }
            const auto [at, apart] = load->second;
            const Vector3d force = Math(wrench.force), torque = Math(wrench.torque);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                values[at + axis * apart] = force[axis];
                values[at + (3 + axis) * apart] = torque[axis];
            }
        }
        Take(values, named);
    }

    // A step of these values, in which so many rotors were named.
    void Take(const Values& values, std::size_t named) {
        if (named != places_.size()) throw Unsound("it must name each rotor once");
        for (double value : values)
            if (!(std::abs(value) <= LARGEST_COMMAND)) throw Unsound("a number is not finite, or beyond 1e8");
        body_.Take(values);
    }

    void Place(const MultiDOFJointState& said) {
        const bool one = said.joint_names.size() == 1 && said.transforms.size() == 1 && said.twist.size() == 1;
        if (!one || said.joint_names[0] != "base_link")
            throw Unsound("it must have wrenches, or one transform and twist of base_link");
        const auto &to = said.transforms[0].translation, &v = said.twist[0].linear, &w = said.twist[0].angular;
        const auto& q = said.transforms[0].rotation;
        const Values state{to.x, to.y, to.z, v.x, v.y, v.z, q.w, q.x, q.y, q.z, w.x, w.y, w.z};
        if (!Finite(state) || q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z < 1e-9)
            throw Unsound("a number is not finite, or the rotation is none");
        body_.Place(state, 0);
        stamp_ += tick_;
        TellStanding();
    }

    void OnPush(const WrenchStamped& said) {
        const Push push{Math(said.wrench.force), Math(said.wrench.torque), Vector3d::Zero, PUSH_HELD};
        const std::string& frame = said.header.frame_id;
        if (frame != "" && frame != "world" && frame != "base_world")
            gzerr << "tandemlift: a push in frame " << frame << " is refused: it must be base_world\n";
        else if (!(push.force.Length() <= LARGEST_PUSH && push.moment.Length() <= LARGEST_PUSH))
            gzerr << "tandemlift: a push of more than 10000 N or N m is refused\n";
        else
            body_.Hold(push);
    }

    void OnLead(const ros::MessageEvent<std_msgs::Empty const>& event) {
        const std::string& name = event.getPublisherName();
        body_.Led() && name == pilot_ ? TellPilot(name) : Lead(name);
    }

    Values rotors_, told_;
    ros::CallbackQueue queue_;
    std::unique_ptr<ros::NodeHandle> node_;
    Topics topics_;
    ros::Publisher pilot_topic_;
    std::vector<ros::Subscriber> heard_;
    std::map<std::string, std::size_t> places_;                         // of rotors in a Command
    std::map<std::string, std::pair<std::size_t, std::size_t>> loads_;  // where they begin there, how far apart
    ros::Time stamp_{1, 0};  // of the last state
    ros::Duration tick_;
    Clock::time_point published_;
    std::string namespace_, pilot_;
    std::set<std::string> refused_;
    Body body_;  // ends first: its events call the rest
};

GZ_REGISTER_MODEL_PLUGIN(TandemliftRosPlugin)

}  // namespace tandemlift
