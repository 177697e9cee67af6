// A module in JavaScript: hears words typed on standard input as if a visitor had said them, and shows the answers.
//
//     npm install amqplib
//     LUMEN_BUS=amqp://NAME:PASSWORD@HOST/ node listener.mjs
import readline from "node:readline";
import amqplib from "amqplib";

const end = (error) => {
  console.error(`listener: the broker can't be used: ${error.message}`);
  process.exit(1);
};
const connection = await amqplib.connect(process.env.LUMEN_BUS).catch(end);
connection.on("error", end);
const channel = await connection.createConfirmChannel();
const { queue } = await channel.assertQueue("", { exclusive: true });
await channel.bindQueue(queue, "amq.topic", "lumen.audio.text.stream");
await channel.consume(queue, (message) => console.log("Lumen:", JSON.parse(message.content).text), { noAck: true });
console.log("listening");
for await (const line of readline.createInterface({ input: process.stdin })) {
  const heard = { name: "listener", result: line, date: new Date().toISOString() };
  channel.publish("amq.topic", "lumen.audio.speech.recognition", Buffer.from(JSON.stringify(heard)));
  await channel.waitForConfirms();
}
await connection.close();
