// The way to the program: pictures and words come, questions go.

import { Picture } from "./picture.js";

const RETRIES = 4;

// `on.picture(picture, drawn)` calls `drawn` when the picture is on the screen; `on.words(message)`;
// `on.state("here" | "away" | "gone")`.
export function connect(on) {
  const token = new URLSearchParams(location.search).get("token") ?? "";
  const way = location.protocol === "https:" ? "wss:" : "ws:";
  let socket, failed = 0;

  function open() {
    socket = new WebSocket(`${way}//${location.host}/ws?token=${encodeURIComponent(token)}`);
    socket.binaryType = "arraybuffer";
    const own = socket;
    const drawn = () => own.readyState === WebSocket.OPEN && own.send(JSON.stringify("drawn"));
    socket.onopen = () => {
      failed = 0;
      on.state("here");
    };
    socket.onmessage = ({ data }) => {
      if (typeof data === "string") on.words(JSON.parse(data));
      else on.picture(new Picture(data), drawn);
    };
    socket.onclose = () => {
      failed += 1;
      on.state(failed > RETRIES ? "gone" : "away");
      if (failed <= RETRIES) setTimeout(open, 500 * 2 ** failed);
    };
  }
  open();
  return {
    ask(command) {
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({ ask: command }));
    },
  };
}
