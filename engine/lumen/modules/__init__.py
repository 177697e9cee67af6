"""The paper's other modules: database, visual, audio and social media. They know the exhibition by the bus alone.

Each is a folder or a file, started by `lumen run` or as a process of its own:

    memory/     the database: a journal and the visitors, in SQLite
    eyes/       faces, whose they are, and people in a camera's images, with OpenCV
    ears/       recordings that become texts, with PocketSphinx or a Whisper of the house
    voice/      texts that become sound, with espeak-ng
    show/       lamps, screens and sound desks, which speak MQTT, OSC or DMX
    answers/    a language model on a short leash, asked what no passage answers
    social.py   a stand-in for social media, which writes the posts into a file

and what they share:

    module.py   what every module is: routes that it hears, a thread of its own, and trouble that is said once
    sound.py    sound in a message: WAV in base64
    audio_track.py   what is heard in a run, each sound at its time
"""
