// The agent of bridge_cost.cpp in JavaScript, for Node. Reads and writes wait, as the protocol does.
const fs = require("fs");

const room = Buffer.alloc(65536);
let rest = Buffer.alloc(0);

function line() {
  for (;;) {
    const end = rest.indexOf(10);
    if (end >= 0) {
      const text = rest.toString("utf8", 0, end);
      rest = rest.subarray(end + 1);
      return JSON.parse(text);
    }
    const count = fs.readSync(0, room, 0, room.length, null);
    if (count === 0) return null;
    rest = Buffer.concat([rest, room.subarray(0, count)]);
  }
}

function say(what) {
  fs.writeSync(1, JSON.stringify(what) + "\n");
}

for (let told = line(); told !== null; told = line()) {
  if (told.hello) {
    say({ hello: { protocol: 1, name: "ticker", deterministic: true } });
  } else if (told.bye) {
    say({ bye: {} });
  } else if (told.event) {
    const ticks = told.event === "start" || told.event === "timer";
    say({ calls: ticks ? [["get_position"], ["set_timer", 0, told.now_ns + 50000000]] : [] });
  }
}
