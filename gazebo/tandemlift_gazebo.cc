// The body of a flight in Gazebo 11: a plugin of the model `tandemlift`, led step by step over UDP on loopback.
// The model: vehicle.hh. Modes, settings, and the numbers of a Command, Told and Rotors: body.hh. Pushes: push.hh.
//
// Setting of the <plugin>
//   <port>      UDP port on 127.0.0.1; 19110
//
// Messages are a Header and a fixed number of doubles, both little-endian:
//   HELLO    pilot   flags (1: place the vehicle, 2: in real time), step [s], State (13), Rotors (12 N)
//   WELCOME  plugin  as STATE
//   STEP     pilot   Command
//   STATE    plugin  Told
//   BYE      pilot   nothing
//   REFUSE   plugin  why (enum Why)
// STEP k is answered by STATE k. A STEP that comes again gets the same answer again, and moves nothing; it says that
// the pilot lives.

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <cstdint>
#include <cstring>
#include <set>

#include "body.hh"

namespace tandemlift {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "messages are little-endian");

constexpr std::uint32_t MAGIC = 0x5a474c54;  // "TLGZ"
constexpr std::uint16_t VERSION = 2;
constexpr int DEFAULT_PORT = 19110;

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

class TandemliftPlugin : public gazebo::ModelPlugin, Front {
  public:
    void Load(gazebo::physics::ModelPtr model, sdf::ElementPtr settings) override {
        const int port = settings->Get<int>("port", DEFAULT_PORT).first;
        try {
            body_.Load(model, settings);
        } catch (const std::runtime_error& error) {
            gzerr << "tandemlift: model " << model->GetName() << " has " << error.what() << "; the plugin rests\n";
            return;
        }
        if (!post_.Open(port)) {
            gzerr << "tandemlift: UDP port " << port << " is taken; the plugin rests\n";
            return;
        }
        body_.Start(*this);
        gzmsg << "tandemlift: " << body_.Count() << " quadrotors, UDP port " << port << "\n";
    }

    void Reset() override { body_.EndPushes(); }

  private:
    bool Hear(int milliseconds) override {
        if (!post_.Receive(milliseconds)) return false;
        Heed();
        return true;
    }

    void Tell() override {
        if (!body_.Led() || !body_.Due()) return;
        body_.Tell(told_);
        Answer(STATE);
    }

    void Heed() {
        const Header& head = post_.header;
        if (head.version != VERSION) return Refuse(OTHER_VERSION);
        if (head.count != body_.Count()) return Refuse(OTHER_COUNT);
        if (!Finite(post_.numbers)) return Refuse(NOT_FINITE);
        const std::size_t N = body_.Count(), size = post_.numbers.size();
        if (head.kind == HELLO) {
            const bool sound = post_.whole && size == 15 + 12 * N && post_.numbers[0] >= 0.0 && post_.numbers[0] < 4.0;
            return sound ? Welcome() : Refuse(MALFORMED);
        }
        if (!body_.Led() || head.session != session_) return head.kind == BYE ? void() : Refuse(OVER);
        if (head.kind == BYE) {
            body_.Goodbye();
        } else if (head.kind != STEP || !post_.whole || size != 10 * N + 12) {
            Refuse(MALFORMED);
        } else {
            body_.Alive();
            if (head.sequence == sequence_ + 1) {
                body_.Take(post_.numbers);
                ++sequence_;
            } else if (head.sequence == sequence_ && sequence_ > 0) {
                post_.Send(answer_, told_);
            }
        }
    }

    // A hello: a session that was heard once never begins again, so that a late copy changes nothing.
    void Welcome() {
        const Header& head = post_.header;
        if (body_.Led() && head.session == session_ && sequence_ == 0) return post_.Send(answer_, told_);
        if (!sessions_.insert(head.session).second) return;
        session_ = head.session;
        sequence_ = 0;
        const auto& said = post_.numbers;
        const int flags = static_cast<int>(said[0]);
        if (flags & PLACE) body_.Place(said, 2);
        body_.Lead({said.begin() + 15, said.end()});
        body_.Pace(flags & REAL_TIME);
        body_.TellStanding(told_);
        Answer(WELCOME);
    }

    void Answer(Kind kind) {
        answer_ = Head(kind, sequence_);
        post_.Send(answer_, told_);
    }

    void Refuse(Why why) const { post_.Send(Head(REFUSE, post_.header.sequence), {static_cast<double>(why)}); }

    Header Head(Kind kind, std::uint64_t sequence) const {
        return {MAGIC, VERSION, kind, post_.header.session, static_cast<std::uint32_t>(body_.Count()), sequence};
    }

    Post post_;
    std::uint32_t session_ = 0;
    std::uint64_t sequence_ = 0;  // of the last step taken
    std::set<std::uint32_t> sessions_;
    std::vector<double> told_;
    Header answer_{};
    Body body_;  // ends first: its events call the rest
};

GZ_REGISTER_MODEL_PLUGIN(TandemliftPlugin)

}  // namespace tandemlift
