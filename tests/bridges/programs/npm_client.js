// What a vehicle's software does with `mqtt` of npm: a will, a kept session, QoS 0 and 1, reconnecting by itself.
// node npm_client.js FOLDER-OF-node_modules PORT; on "cut!" on its output, the connections have to be cut.
const mqtt = require(require('path').join(process.argv[2], 'mqtt'));
const url = 'mqtt://127.0.0.1:' + process.argv[3];
let failed = 0;
const check = (holds, what) => {
  console.log((holds ? 'ok' : 'FAILED') + ': ' + what);
  if (!holds) failed = 1;
};
const within = (promise) => Promise.race([promise, new Promise((_, no) => setTimeout(() => no('too late'), 5000))]);
const once = (client, event) => within(new Promise((yes) => client.once(event, (...all) => yes(all))));

async function run() {
  const will = {topic: 'c/npm', payload: Buffer.from('CONNECTIONBROKEN'), qos: 1, retain: true};
  const agv = mqtt.connect(url, {clientId: 'npm', clean: false, keepalive: 20, reconnectPeriod: 300, will});
  const [first] = await once(agv, 'connect');
  check(!first.sessionPresent, 'a kept session begins');
  const granted = await within(agv.subscribeAsync({order: {qos: 1}, 'v/+/state': {qos: 2}}));
  check(granted.map((one) => one.qos).join() === '1,1', 'QoS 1, and QoS 1 instead of 2');
  await within(agv.publishAsync('c/npm', 'ONLINE', {qos: 1, retain: true}));
  const state = once(agv, 'message');
  agv.publish('v/1/state', '{"headerId":1}');
  check((await state)[1].toString() === '{"headerId":1}', 'QoS 0 comes');

  const master = mqtt.connect(url, {clientId: 'npmMaster', keepalive: 20, reconnectPeriod: 300});
  await once(master, 'connect');
  const retained = once(master, 'message');
  await within(master.subscribeAsync('c/#', {qos: 1}));
  const [topic, payload, packet] = await retained;
  check(topic === 'c/npm' && payload.toString() === 'ONLINE' && packet.retain, 'the retained message comes');
  const ordered = once(agv, 'message');
  await within(master.publishAsync('order', 'o1', {qos: 1}));
  check((await ordered)[1].toString() === 'o1', 'an order comes');

  const done = agv.handleMessage;
  agv.handleMessage = () => {};  // the next message gets no PUBACK
  const taken = once(agv, 'message');
  await within(master.publishAsync('order', 'o2', {qos: 1}));
  check((await taken)[2].dup === false, 'an order comes for the first time');

  const back = Promise.all([once(agv, 'connect'), once(master, 'connect')]);
  const gone = Promise.all([once(agv, 'close'), once(master, 'close')]);
  console.log('cut!');
  await gone;
  agv.handleMessage = done;
  const late = within(master.publishAsync('order', 'o3', {qos: 1}));
  const messages = [];
  const both = within(new Promise((yes) => agv.on('message', (...all) => messages.push(all) === 2 && yes())));
  const [[agvAgain]] = await back;
  check(agvAgain.sessionPresent, 'its session is there after the cut');
  await late;
  await both;
  check(messages[0][1].toString() === 'o2' && messages[0][2].dup, 'the order without a PUBACK comes again, with DUP');
  check(messages[1][1].toString() === 'o3' && !messages[1][2].dup, 'an order that was given during the cut comes');
  const pong = once(agv, 'packetreceive');
  agv.sendPing();
  check((await pong)[0].cmd === 'pingresp', 'a ping is answered');
  await within(agv.unsubscribeAsync('v/+/state'));
  await within(agv.publishAsync('c/npm', '', {retain: true}));
  await agv.endAsync();
  await master.endAsync();
  process.exit(failed);
}
run().catch((error) => {
  console.log('FAILED: ' + error);
  process.exit(1);
});
