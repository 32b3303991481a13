#include "ui/panels/sending.hpp"

#include "retarget/live/pose_sender.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/dialogs.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

/// At the same host; where the port was the usual one, at the other's usual one.
Address with_protocol(Address address, const std::string& scheme) {
  if (address.port == send_address(address.scheme).port) address.port = send_address(scheme).port;
  address.scheme = scheme;
  return address;
}

void draw_address(const Address& address, PanelContext& context) {
  int which = address.scheme == "vmc" ? 0 : 1;
  const Control protocol{"send.protocol",
                         "As",
                         "What the receiver understands",
                         "",
                         {"The VMC protocol: bones by their VRM names, as virtual characters and plug-ins "
                          "of engines take them",
                          "The 22 joints in the world, metres, with their confidence: plain OSC messages"}};
  if (choice_row(context.ui, protocol, {"VMC", "OSC joints"}, which))
    context.ask("poses.address", {with_protocol(address, which == 0 ? "vmc" : "osc").text()});
  const auto typed = text_row(context.ui, {"send.address", "To", "A computer and its UDP port"},
                              address.text().substr(address.scheme.size() + 3), "HOST:PORT");
  if (typed) context.ask("poses.address", {address.scheme + "://" + *typed});
}

std::string state_words(const app::Session& session) {
  if (session.sends_to.empty()) return "Off. Nobody need listen yet: it can be switched on at any time.";
  const app::TakeState* const take = selected_state(session);
  if (take == nullptr || take->shown.poses.empty()) return "On: nothing is shown that performs.";
  return "On: the current take is sent as it is shown, played or moved by hand.";
}

}  // namespace

bool draw_sending(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "send", "Send to an engine", 440)) return true;
  draw_address(send_address(session.settings.send_to), context);
  bool is_on = !session.sends_to.empty();
  if (toggle_row(ui, {"send.on", "Send", "Every pose that is shown of the current take"}, is_on))
    context.ask("poses.send", {on_off(is_on)});
  hint(ui, state_words(session));
  ui.mark("send.state");
  ImGui::Dummy({0, ui.px(4)});
  ButtonOptions close;
  close.look = ButtonLook::Main, close.width = -1;
  return finish_dialog(!button(ui, "send.close", "Close", close));
}

}  // namespace understudy::ui
