#include "devices/transport/serial_transport.h"

#include <algorithm>
#include <ctime>
#include <numeric>
#include <stdexcept>

#include <csignal>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "devices/simulator/pty.h"
#include "devices/transport/port_access.h"
#include "tests/devices/event_loop.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

int g_messages = 0;
void countMessage(QtMsgType, const QMessageLogContext&, const QString&) { ++g_messages; }

class SerialTransport : public testing::Test {
protected:
    void make(const std::string& path, int baud = 57600) {
        transport_ =
            makeSerialTransport({path, baud}, {[this] { ++opened_; },
                                               [this](std::span<const std::uint8_t> bytes) {
                                                   received_.insert(received_.end(), bytes.begin(), bytes.end());
                                                   if (closeOnReceipt_) transport_->close();
                                               },
                                               [this](const LinkTrouble& why) { troubles_.push_back(why); }});
    }
    /// What it says when it is opened at `path`; nothing where it opens.
    LinkTrouble troubleOf(const std::string& path, int baud = 57600) {
        make(path, baud);
        transport_->open();
        return troubles_.empty() ? LinkTrouble{} : troubles_.back();
    }

    /// A name of the pseudo-terminal that goes when it is unplugged, as a real port's node does; its number may be
    /// another program's in the next moment.
    class Node {
    public:
        explicit Node(const Pty& pty) : path_(testing::TempDir() + "lumorph_node_" + std::to_string(::getpid())) {
            ::unlink(path_.c_str());
            if (::symlink(pty.path().c_str(), path_.c_str()) != 0) throw std::runtime_error("no link");
        }
        ~Node() { remove(); }
        Node(const Node&) = delete;
        Node& operator=(const Node&) = delete;
        [[nodiscard]] const std::string& path() const { return path_; }
        void remove() const { ::unlink(path_.c_str()); }

    private:
        std::string path_;
    };

    EventLoop loop_;
    Pty pty_;
    int opened_ = 0;
    Bytes received_;
    std::vector<LinkTrouble> troubles_;
    bool closeOnReceipt_ = false;
    std::unique_ptr<Transport> transport_;
};

TEST_F(SerialTransport, CarriesEveryByteBothWays) {
    make(pty_.path());
    EXPECT_FALSE(transport_->isOpen());
    transport_->open();
    ASSERT_TRUE(transport_->isOpen());
    EXPECT_EQ(opened_, 1);
    transport_->open(); // open already
    EXPECT_EQ(opened_, 1);

    Bytes all(256);
    std::iota(all.begin(), all.end(), std::uint8_t{0});
    transport_->write(all);
    // It has left at once, without a turn of the event loop.
    EXPECT_EQ(transport_->unsent(), 0u);
    EXPECT_EQ(pty_.receive(), all);
    std::ranges::reverse(all);
    pty_.send(all);
    ASSERT_TRUE(EventLoop::runUntil([&] { return received_.size() == all.size(); }, 2s));
    EXPECT_EQ(received_, all);
    EXPECT_TRUE(troubles_.empty());
}

TEST_F(SerialTransport, ADeadPortIsClosedOnceAndCostsNothing) {
    const Node node(pty_);
    make(node.path());
    transport_->open();
    ASSERT_TRUE(transport_->isOpen());
    g_messages = 0;
    const auto before = qInstallMessageHandler(countMessage);
    node.remove();
    pty_.unplug();
    ASSERT_TRUE(EventLoop::runUntil([&] { return !troubles_.empty(); }, 1s));
    EXPECT_FALSE(transport_->isOpen());
    const std::clock_t spent = std::clock();
    EventLoop::runFor(300ms);
    const double seconds = static_cast<double>(std::clock() - spent) / CLOCKS_PER_SEC;
    qInstallMessageHandler(before);

    EXPECT_EQ(troubles_.size(), 1u);
    EXPECT_EQ(g_messages, 0);
    EXPECT_LT(seconds, 0.15); // a flood of errors takes all of the 0.3
    EXPECT_EQ(transport_->unsent(), 0u);
    transport_->write(Bytes{1, 2, 3}); // dropped
    EXPECT_EQ(troubles_.size(), 1u);
    transport_->open();
    ASSERT_EQ(troubles_.size(), 2u);
    // The node is gone with its far end, so both tell the same.
    EXPECT_EQ(troubles_[0], troubles_[1]);
    EXPECT_EQ(troubles_[0].why, "there is no port " + node.path());
}

TEST_F(SerialTransport, AWriteMayBeWhatFindsItDead) {
    make(pty_.path());
    transport_->open();
    pty_.unplug();
    for (int i = 0; i < 100; ++i) transport_->write(Bytes{1, 2, 3});
    EXPECT_TRUE(EventLoop::runUntil([&] { return !transport_->isOpen(); }, 1s));
    EventLoop::runFor(20ms);
    EXPECT_EQ(troubles_.size(), 1u);
}

TEST_F(SerialTransport, IsSilentOnceItWasClosed) {
    make(pty_.path());
    closeOnReceipt_ = true;
    transport_->open();
    pty_.send(Bytes(3000, 7));
    ASSERT_TRUE(EventLoop::runUntil([&] { return !received_.empty(); }, 2s));
    const std::size_t count = received_.size();
    pty_.unplug();
    EventLoop::runFor(20ms);
    EXPECT_EQ(received_.size(), count);
    EXPECT_TRUE(troubles_.empty());
    EXPECT_FALSE(transport_->isOpen());
}

TEST_F(SerialTransport, OpensAgain) {
    make(pty_.path());
    for (int round = 1; round <= 3; ++round) {
        transport_->open();
        ASSERT_EQ(opened_, round);
        pty_.send({42});
        ASSERT_TRUE(EventLoop::runUntil([&] { return received_.size() == static_cast<std::size_t>(round); }, 2s));
        transport_->close();
    }
    EXPECT_TRUE(troubles_.empty());
}

TEST_F(SerialTransport, TellsWhatAStalledLinkHoldsBackAndDropsItOnClose) {
    make(pty_.path());
    transport_->open();
    const Bytes much(1 << 20, 0x55);
    transport_->write(much); // nobody reads
    EXPECT_GT(transport_->unsent(), much.size() / 2);
    transport_->close();
    EXPECT_EQ(transport_->unsent(), 0u);
    EXPECT_TRUE(troubles_.empty());
}

TEST_F(SerialTransport, SaysWhatIsNoSerialPort) {
    EXPECT_EQ(troubleOf("/dev/ttyNone").why, "there is no port /dev/ttyNone");
    EXPECT_EQ(troubleOf("/dev").why, "/dev is not a device");
    EXPECT_EQ(troubleOf("/proc/version").why, "/proc/version is not a device");
    EXPECT_THAT(troubleOf("/dev/full").why, HasSubstr("/dev/full cannot be used as a serial port"));
    EXPECT_EQ(troubles_.size(), 4u);
    for (const LinkTrouble& trouble : troubles_) EXPECT_FALSE(trouble.remedy.empty());
    EXPECT_EQ(opened_, 0);
}

/// Root may do anything: it is nobody while this lives.
class NotRoot {
public:
    NotRoot() : user_(::geteuid()) {
        if (user_ == 0 && ::seteuid(65534) != 0) throw std::runtime_error("cannot be nobody");
    }
    ~NotRoot() { (void)!::seteuid(user_); }
    NotRoot(const NotRoot&) = delete;
    NotRoot& operator=(const NotRoot&) = delete;

private:
    uid_t user_;
};

TEST_F(SerialTransport, NamesTheGroupWhereAPermissionIsMissing) {
    ASSERT_EQ(::chmod(pty_.path().c_str(), 0), 0);
    const LinkTrouble trouble = [this] {
        const NotRoot user;
        return troubleOf(pty_.path());
    }();
    EXPECT_EQ(trouble.why, "permission denied on " + pty_.path());
    EXPECT_THAT(trouble.remedy, HasSubstr("sudo usermod -aG dialout $USER"));
    EXPECT_THAT(trouble.remedy, HasSubstr("log in again"));
}

/// Another program that has a port open and locked while this lives.
class OtherProgram {
public:
    OtherProgram(const std::string& path, const char* name) {
        int ready[2];
        if (::pipe(ready) != 0) throw std::runtime_error("no pipe");
        process_ = ::fork();
        if (process_ == 0) {
            ::prctl(PR_SET_NAME, name);
            ::flock(::open(path.c_str(), O_RDWR | O_NOCTTY), LOCK_EX);
            (void)!::write(ready[1], "x", 1);
            ::pause();
            ::_exit(0);
        }
        char byte = 0;
        (void)!::read(ready[0], &byte, 1);
        ::close(ready[0]);
        ::close(ready[1]);
    }
    ~OtherProgram() {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    OtherProgram(const OtherProgram&) = delete;
    OtherProgram& operator=(const OtherProgram&) = delete;
    [[nodiscard]] int process() const { return process_; }

private:
    pid_t process_ = -1;
};

TEST_F(SerialTransport, NamesTheProgramThatHasThePort) {
    const OtherProgram other(pty_.path(), "picocom");
    const LinkTrouble trouble = troubleOf(pty_.path());
    EXPECT_EQ(trouble.why, "the program picocom uses " + pty_.path());
    EXPECT_EQ(trouble.remedy, "close picocom");
    EXPECT_EQ(holderOf(pty_.path())->process, other.process());
    EXPECT_FALSE(holderOf("/dev/ttyNone"));
}

TEST_F(SerialTransport, HasThePortForItself) {
    ASSERT_EQ(troubleOf(pty_.path()), LinkTrouble{});
    std::vector<LinkTrouble> troubles;
    // By another name too, which a lock file would not notice.
    const std::string link = testing::TempDir() + "lumorph_port_" + std::to_string(::getpid());
    ASSERT_EQ(::symlink(pty_.path().c_str(), link.c_str()), 0);
    for (const std::string& path : {pty_.path(), link}) {
        const auto second = makeSerialTransport(
            {path, 9600}, {[] {}, [](auto) {}, [&](const LinkTrouble& why) { troubles.push_back(why); }});
        second->open();
        EXPECT_FALSE(second->isOpen());
    }
    ::unlink(link.c_str());
    ASSERT_EQ(troubles.size(), 2u);
    EXPECT_EQ(troubles[0].why, "this program uses " + pty_.path() + " already");
    EXPECT_EQ(troubles[1].why, "this program uses " + link + " already");
    // And the first has not suffered from it.
    pty_.send({1, 2});
    EXPECT_TRUE(EventLoop::runUntil([&] { return received_.size() == 2; }, 2s));
    transport_->write(Bytes{3});
    EXPECT_EQ(pty_.receive(), Bytes{3});
}

} // namespace
} // namespace lumorph
